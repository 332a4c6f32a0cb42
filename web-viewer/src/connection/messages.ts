import type {
  Command,
  CommandResult,
  Diagnostics,
  Dial,
  Event,
  Recording,
  SceneFacts,
  Settings,
  Stream,
  Timeline,
  Welcome,
} from "../gen/spherule/v1/control_pb";
import type { Status, Tier } from "../gen/spherule/v1/frame_pb";

/** What passes between the page and the worker that holds its connection. */

export type LinkState = "connecting" | "open" | "waiting";

/** A state of all spheres. */
export interface State {
  sequence: number;
  epoch: number;
  step: number;
  simTime: number; // s
  count: number;
  positions: Float32Array; // x y z per sphere, in id order; m, from the centre of the bounds
  quantum: number; // m: each is off by at most half of it
}

export interface Received extends State {
  arrival: number; // ms, as sharedNow() says
  ready: number; // ms since 1970 by the server's clock; 0: not said
  bytes: number; // of the whole message
  decodeMs: number;
  status: Status | undefined;
}

/** What the page wants to be sent. */
export interface View {
  tier: Tier;
  rate: number; // frames per second; 0: none
  fixed: boolean;
}

export type FromWorker =
  | { kind: "link"; state: LinkState; at: number; retryIn?: number; reason?: string } // at: when, as sharedNow() says; retryIn: ms
  | { kind: "silent"; since: number | undefined } // when the server was last heard, as sharedNow() says; undefined: just now
  | { kind: "welcome"; welcome: Welcome }
  | { kind: "scene"; facts: SceneFacts }
  | { kind: "settings"; settings: Settings }
  | { kind: "stream"; stream: Stream }
  | { kind: "frame"; frame: Received }
  | { kind: "result"; result: CommandResult }
  | { kind: "event"; event: Event }
  | { kind: "diagnostics"; diagnostics: Diagnostics }
  | { kind: "dial"; dial: Dial }
  | { kind: "timeline"; timeline: Timeline }
  | { kind: "recording"; recording: Recording }
  | { kind: "lost"; count: number } // frames that could not be decoded since the page was loaded
  | { kind: "broken"; reason: string }; // a message that could not be read

export type ToWorker =
  | { kind: "connect"; url: string; view: View }
  | { kind: "retry" }
  | { kind: "view"; view: View }
  | { kind: "drawing"; rate: number } // pictures per second; 0: unknown
  | { kind: "command"; command: Command }
  | { kind: "recycle"; buffer: ArrayBuffer };
