import type { Commands } from "../connection/commands";
import type { Recording } from "../gen/spherule/v1/control_pb";
import { bytes, clockTime } from "../format";
import type { Session } from "../model/session";
import { observed } from "../observed";
import { live, liveText } from "./bindings";
import { h } from "./dom";

/** A button that starts and stops a recording on the server, and shows its duration and size. */
export class RecordButton {
  readonly element: HTMLElement;
  @observed private accessor pending = false; // a command has no result yet: a second click would revert it

  /** `blocked`: why the user may not send commands; empty if they may. */
  constructor(
    private readonly session: Session,
    private readonly commands: Commands,
    blocked: () => string,
  ) {
    const active = (): boolean => session.recording?.active ?? false;
    const title = (): string =>
      active() ? `Stop recording ${session.recording?.file ?? ""}`.trim() : "Record the simulation, on the server";
    const progress = (): string => {
      const { duration = 0, bytes: size = 0n } = session.recording ?? {};
      return active() ? `${clockTime(duration)} · ${bytes(Number(size))}` : "";
    };
    const words = h("span", { "data-testid": "record-words" }, liveText(progress));
    const attributes = { type: "button", class: "record", "data-testid": "record", click: () => void this.toggle() };
    this.element = live(h("button", attributes, h("i"), live(words, { hidden: () => !active() })), {
      hidden: () => session.playing || !session.recording,
      disabled: () => this.pending || blocked() !== "",
      title: () => blocked() || title(),
      "aria-label": title,
      "aria-pressed": () => String(active()),
    });
  }

  private async toggle(): Promise<void> {
    const { commands, session } = this;
    this.pending = true;
    await (session.recording?.active ? commands.stopRecording() : commands.startRecording());
    this.pending = false;
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
