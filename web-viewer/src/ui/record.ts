import type { Commands } from "../connection/commands";
import type { Recording } from "../gen/spherule/v1/control_pb";
import { bytes, clockTime } from "../format";
import { h, setText } from "./dom";

/** A button that starts and stops a recording on the server, and shows its duration and size. */
export class RecordButton {
  private readonly label = h("span", { "data-testid": "record-words" });
  readonly element = h(
    "button",
    { type: "button", class: "record", "data-testid": "record", click: () => void this.toggle() },
    h("i"),
    this.label,
  );
  private recording: Recording | undefined;
  private blockedReason = "";
  private pending = false; // a command has no result yet: a second click would revert it

  constructor(private readonly commands: Commands) {
    this.update(undefined, "");
  }

  /** `recording` is undefined if the server cannot record. An empty reason enables the button. */
  update(recording: Recording | undefined, blockedReason: string): void {
    const same = recording === this.recording && blockedReason === this.blockedReason;
    if (same && this.element.title) return;
    this.recording = recording;
    this.blockedReason = blockedReason;
    this.enable();
    this.element.hidden = !recording;
    const active = recording?.active ?? false;
    const title = active ? `Stop recording ${recording?.file ?? ""}`.trim() : "Record the simulation, on the server";
    this.element.title = blockedReason || title;
    this.element.setAttribute("aria-label", title);
    this.element.setAttribute("aria-pressed", String(active));
    this.label.hidden = !active;
    const progress = recording && `${clockTime(recording.duration)} · ${bytes(Number(recording.bytes))}`;
    setText(this.label, (active && progress) || "");
  }

  private async toggle(): Promise<void> {
    const { commands, recording } = this;
    this.pending = true;
    this.enable();
    await (recording?.active ? commands.stopRecording() : commands.startRecording());
    this.pending = false;
    this.enable();
  }

  private enable(): void {
    this.element.disabled = this.pending || this.blockedReason !== "";
  }
}

/** The message for the user when a recording has ended. */
export interface RecordingEnd {
  title: string;
  text: string;
  failed: boolean;
  file: string; // name of the recording in the folder of the server
}

/** Returns undefined if no recording has ended. */
export function recordingEnd(recording: Recording, before: Recording | undefined): RecordingEnd | undefined {
  const { active, file, failure } = recording;
  const name = file.split("/").at(-1) ?? file;
  if (!before || active) return undefined;
  if (failure && (before.active || failure !== before.failure)) {
    return { title: "Recording ended", text: failure, failed: true, file: name };
  }
  const text = `Play it with spherule play ${file}`;
  return before.active ? { title: "Recorded", text, failed: false, file: name } : undefined;
}
