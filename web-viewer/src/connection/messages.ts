import type { MessageInitShape } from "@bufbuild/protobuf";
import type { Columns } from "../columns";
import type {
  Change,
  ClientMessageSchema,
  CommandResult,
  CommandSchema,
  Control,
  Event,
  Recording,
  Settings,
  Stream,
  Timeline,
  Welcome,
} from "../gen/spherule/v1/control_pb";
import type { SceneParts } from "../gen/spherule/v1/scene_parts_pb";
import type { Diagnostics, Dial } from "../gen/spherule/v1/diagnostics_pb";
import type { Population, SceneFacts } from "../gen/spherule/v1/facts_pb";
import type { Pose, Quantity, Status, Tier } from "../gen/spherule/v1/frame_pb";

/**
 * Messages between the page and the worker that holds its connection. The worker encodes those for the server from
 * plain objects, so that the page needs no protobuf library.
 */

export type CommandMessage = MessageInitShape<typeof CommandSchema>;
export type CommandCase = NonNullable<CommandMessage["kind"]>["case"];

/** `locked`: the server rejected the token, or requires one; the worker waits for another token. */
export type LinkState = "connecting" | "open" | "waiting" | "locked";

/** A change of the connection's state. Times are in ms, as sharedNow() counts them. */
export interface LinkChange {
  state: LinkState;
  at: number; // time of the change
  retryIn?: number; // ms until the next attempt
  reason?: string; // why the connection is not open
  refused?: boolean; // the server refused this page, and `reason` is the server's
}

/** A message that asks for, keeps or gives away control of the simulation. */
export type ControlMessage = Extract<
  MessageInitShape<typeof ClientMessageSchema>["kind"],
  { case: "askControl" | "yieldControl" | "keepControl" }
>;

/** The order of drawing: the places of an epoch, neighbours near each other. */
export interface DrawOrder {
  epoch: number;
  number: number;
  places: Uint32Array;
}

/** A state of all places for spheres. */
export interface State {
  sequence: number;
  epoch: number;
  step: number;
  simTime: number; // s
  at?: number; // s: time on the timeline; undefined: the simulated time
  count: number; // places
  columns: Columns;
  order: number; // of the order that `boxes` has
  /**
   * The boxes of the centres in each block of the order: low and high corner (m, relative to the centre of the bounds).
   * They are unbounded along periodic axes.
   */
  boxes: Float64Array;
  poses: Pose[]; // of the obstacles that move
}

export interface Received extends State {
  population: number; // number of the last change of the population that the state includes
  arrival: number; // ms, as sharedNow() counts
  ready: number; // ms since 1970 on the server's clock; 0: unknown
  bytes: number; // size of the whole message
  decodeMs: number;
  status: Status | undefined;
}

/** The stream that the user requests. */
export interface ViewRequest {
  tier: Tier;
  rate: number; // frames per second; 0: none
  fixed: boolean; // the server may not lower tier or rate
}

/** The stream that the page requests. */
export interface StreamRequest extends ViewRequest {
  quantity: Quantity; // of each sphere, besides its position
  spins: boolean; // frames have angular velocities, if the spheres rotate
}

/** The part of a live simulation that the page can show again; times on the timeline in s. */
export interface PastRange {
  begin: number;
  end: number; // the present
  frames: number;
}

/** The page shows frames that are not live: of the past of the simulation, or of a file. */
export interface ReplayState {
  source: "past" | "file";
  paused: boolean;
}

const commandsOfPast: CommandCase[] = ["pause", "resume", "step", "seek"];

/** Whether the worker carries out a command itself. It sends all others to the server. */
export function isLocal(command: CommandCase, replay: ReplayState | undefined, past: PastRange | undefined): boolean {
  if (!replay) return command === "seek" && past !== undefined;
  return replay.source === "file" || commandsOfPast.includes(command);
}

/** Whether the page shows the present again after a command to the server. */
export function endsReplay(command: CommandCase): boolean {
  return command !== "startRecording" && command !== "stopRecording" && command !== "inspect";
}

export type FromWorker =
  | ({ kind: "link" } & LinkChange)
  | { kind: "silent"; since: number | undefined } // time of the last message (ms); undefined: messages arrive again
  | { kind: "welcome"; welcome: Welcome }
  | { kind: "scene"; facts: SceneFacts; jump?: boolean } // jump: what follows does not continue what came before
  | { kind: "past"; past: PastRange | undefined } // undefined: there is none
  | { kind: "replay"; replay: ReplayState | undefined } // undefined: the present is shown
  | { kind: "population"; population: Population }
  | { kind: "settings"; settings: Settings }
  | { kind: "parts"; parts: SceneParts }
  | { kind: "stream"; stream: Stream }
  | { kind: "order"; order: DrawOrder }
  | { kind: "frame"; frame: Received }
  | { kind: "result"; result: CommandResult }
  | { kind: "event"; event: Event }
  | { kind: "diagnostics"; diagnostics: Diagnostics }
  | { kind: "dial"; dial: Dial }
  | { kind: "timeline"; timeline: Timeline }
  | { kind: "recording"; recording: Recording }
  | { kind: "control"; control: Control }
  | { kind: "change"; change: Change }
  | { kind: "saved"; file: Blob; name: string }
  | { kind: "told"; title: string; text: string } // something has failed, in words for the user
  | { kind: "lost"; count: number } // frames that could not be decoded since the page was loaded
  | { kind: "unreadable"; reason: string }; // a message or frame is malformed

export type ToWorker =
  | { kind: "connect"; url: string; view: StreamRequest; token: string }
  | { kind: "token"; token: string } // reconnect with this token
  | { kind: "retry" }
  | { kind: "view"; view: StreamRequest }
  | { kind: "drawing"; rate: number } // images per second; 0: unknown
  | { kind: "command"; command: CommandMessage }
  | { kind: "control"; message: ControlMessage }
  | { kind: "present" } // show what the server sends again
  | { kind: "save" } // the past that can be shown
  | { kind: "open"; file: File } // a recording
  | { kind: "recycle"; buffer: ArrayBuffer };
