import type { Recording } from "../gen/spherule/v1/control_pb";
import type { Commands } from "../connection/commands";
import { h, setText } from "./dom";
import { bytes } from "./format";
import { clockTime } from "./moment";

/** Starts and ends a recording on the server, and says how long and large it is. */
export class RecordButton {
  private readonly words = h("span", { "data-testid": "record-words" });
  readonly element = h("button", { type: "button", class: "record", "data-testid": "record", click: () => void this.toggle() }, h("i"), this.words);
  private recording: Recording | undefined;
  private why = "";
  private asked = false; // a second click would ask for the opposite of what is under way

  constructor(private readonly commands: Commands) {
    this.offer(undefined, "");
  }

  /** `recording` undefined: there is nothing to record. `why`: it is out of use; empty: it is not. */
  offer(recording: Recording | undefined, why: string): void {
    if (recording === this.recording && why === this.why && this.element.title) return;
    this.recording = recording;
    this.why = why;
    this.enable();
    this.element.hidden = !recording;
    const active = recording?.active ?? false;
    const title = active ? `Stop recording ${recording?.file ?? ""}`.trim() : "Record what is simulated, on the server";
    this.element.title = why || title;
    this.element.setAttribute("aria-label", title);
    this.element.setAttribute("aria-pressed", String(active));
    this.words.hidden = !active;
    setText(this.words, active && recording ? `${clockTime(recording.duration)} · ${bytes(Number(recording.bytes))}` : "");
  }

  private async toggle(): Promise<void> {
    const { commands, recording } = this;
    this.asked = true;
    this.enable();
    await (recording?.active ? commands.stopRecording() : commands.record());
    this.asked = false;
    this.enable();
  }

  private enable(): void {
    this.element.disabled = this.asked || this.why !== "";
  }
}

/** What a person is told when a recording has ended; undefined: none has. */
export function endOf(recording: Recording, before: Recording | undefined): { title: string; text: string; failed: boolean } | undefined {
  const { active, file, failure } = recording;
  if (!before || active) return undefined;
  if (failure && (before.active || failure !== before.failure)) return { title: "Recording ended", text: failure, failed: true };
  return before.active ? { title: "Recorded", text: `Play it with spherule play ${file}`, failed: false } : undefined;
}
