import type {
  Change,
  ClientMessage,
  Command,
  CommandResult,
  Control,
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

/** `locked`: the server wants a token, or another one; nothing is tried until there is one. */
export type LinkState = "connecting" | "open" | "waiting" | "locked";

/** How the page is with its server, and since when, as sharedNow() says. */
export interface LinkChange {
  state: LinkState;
  at: number; // ms
  retryIn?: number; // ms
  reason?: string; // why it is not open
  refused?: boolean; // the server has turned this page away, and the reason is its own
}

/** What is said about who has the controls. */
export type ControlWish = Extract<ClientMessage["kind"], { case: "askControl" | "yieldControl" | "keepControl" }>;

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
  | ({ kind: "link" } & LinkChange)
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
  | { kind: "control"; control: Control }
  | { kind: "change"; change: Change }
  | { kind: "lost"; count: number } // frames that could not be decoded since the page was loaded
  | { kind: "broken"; reason: string }; // a message that could not be read

export type ToWorker =
  | { kind: "connect"; url: string; view: View; token: string }
  | { kind: "token"; token: string } // for the next hello, which is said at once
  | { kind: "retry" }
  | { kind: "view"; view: View }
  | { kind: "drawing"; rate: number } // pictures per second; 0: unknown
  | { kind: "command"; command: Command }
  | { kind: "control"; wish: ControlWish }
  | { kind: "recycle"; buffer: ArrayBuffer };
