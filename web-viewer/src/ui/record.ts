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

  constructor(private readonly commands: Commands) {
    this.offer(undefined);
  }

  /** undefined: there is nothing to record. */
  offer(recording: Recording | undefined): void {
    if (recording === this.recording && this.element.title) return;
    this.recording = recording;
    this.element.hidden = !recording;
    const active = recording?.active ?? false;
    const title = active ? `Stop recording ${recording?.file ?? ""}`.trim() : "Record what is simulated, on the server";
    this.element.title = title;
    this.element.setAttribute("aria-label", title);
    this.element.setAttribute("aria-pressed", String(active));
    this.words.hidden = !active;
    setText(this.words, active && recording ? `${clockTime(recording.duration)} · ${bytes(Number(recording.bytes))}` : "");
  }

  private async toggle(): Promise<void> {
    const { element, commands, recording } = this;
    element.disabled = true; // a second click would ask for the opposite of what is under way
    await (recording?.active ? commands.stopRecording() : commands.record());
    element.disabled = false;
  }
}

/** What a person is told when a recording has ended; undefined: none has. */
export function endOf(recording: Recording, before: Recording | undefined): { title: string; text: string; failed: boolean } | undefined {
  const { active, file, failure } = recording;
  if (!before || active) return undefined;
  if (failure && (before.active || failure !== before.failure)) return { title: "Recording ended", text: failure, failed: true };
  return before.active ? { title: "Recorded", text: `Play it with spherule play ${file}`, failed: false } : undefined;
}
