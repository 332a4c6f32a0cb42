import type { Command, CommandResult, Diagnostics, Dial, Event, SceneFacts, Settings, Welcome } from "../gen/spherule/v1/control_pb";
import type { Status } from "../gen/spherule/v1/frame_pb";

/** What passes between the page and the worker that holds its connection. */

export type LinkState = "connecting" | "open" | "waiting";

/** A state of all spheres, in units of the wire grid: x y z per sphere, in id order. */
export interface State {
  sequence: number;
  epoch: number;
  step: number;
  simTime: number; // s
  count: number;
  positions: Uint16Array;
}

export interface Received extends State {
  arrival: number; // ms, as sharedNow() says
  bytes: number; // of the whole message
  status: Status | undefined;
}

export type FromWorker =
  | { kind: "link"; state: LinkState; retryIn?: number; reason?: string } // retryIn: ms
  | { kind: "welcome"; welcome: Welcome }
  | { kind: "scene"; facts: SceneFacts }
  | { kind: "settings"; settings: Settings }
  | { kind: "frame"; frame: Received }
  | { kind: "result"; result: CommandResult }
  | { kind: "event"; event: Event }
  | { kind: "diagnostics"; diagnostics: Diagnostics }
  | { kind: "dial"; dial: Dial }
  | { kind: "broken"; reason: string }; // a message that could not be read

export type ToWorker =
  | { kind: "connect"; url: string }
  | { kind: "retry" }
  | { kind: "command"; command: Command }
  | { kind: "recycle"; buffer: ArrayBuffer };
