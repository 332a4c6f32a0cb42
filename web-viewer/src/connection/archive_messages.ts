import type { Settings, Welcome } from "../gen/spherule/v1/control_pb";
import type { Segment } from "./history";

/** Messages between the connection's thread and the thread that writes and reads recordings. */

export type ToArchive =
  | { kind: "write"; segments: readonly Segment[]; welcome: Welcome | undefined }
  | { kind: "read"; file: Blob; name: string };

/** The content of a recording, for playback. */
export interface RecordingContent {
  segments: Segment[];
  settings: Settings | undefined; // at the beginning
  source: Welcome | undefined; // the program that made it
  end: number; // s
  flaw: string; // why it ends early; empty if it does not
  damage: string[]; // parts that are left out
}

export type FromArchive =
  | { kind: "written"; file: Blob; frames: number }
  | { kind: "read"; content: RecordingContent }
  | { kind: "failed"; reason: string };
