import { fromBinary } from "@bufbuild/protobuf";
import { ServerMessageSchema } from "../gen/spherule/v1/control_pb";
import type { ServerMessage } from "../gen/spherule/v1/control_pb";
import type { FromWorker } from "./messages";

/** The name in this page's hello, which the server shows to other clients. */
export const clientName = "spherule viewer";

export const subprotocol = "spherule.v1";

export const tokenRequired = 4401; // WebSocket close code
export const refusals = [1008, 1013]; // close codes of a server that refuses this page

type Kind = ServerMessage["kind"];

/** Parses one message of the server. Throws the error of protobuf on malformed bytes. */
export function decode(message: Uint8Array): Kind {
  return fromBinary(ServerMessageSchema, message).kind;
}

/** Converts a message that is passed to the page unchanged. Undefined for frames, orders and unknown kinds. */
export function forPage(kind: Kind): FromWorker | undefined {
  switch (kind.case) {
    case "welcome":
      return { kind: "welcome", welcome: kind.value };
    case "scene":
      return { kind: "scene", facts: kind.value };
    case "population":
      return { kind: "population", population: kind.value };
    case "settings":
      return { kind: "settings", settings: kind.value };
    case "parts":
      return { kind: "parts", parts: kind.value };
    case "result":
      return { kind: "result", result: kind.value };
    case "event":
      return { kind: "event", event: kind.value };
    case "diagnostics":
      return { kind: "diagnostics", diagnostics: kind.value };
    case "dial":
      return { kind: "dial", dial: kind.value };
    case "stream":
      return { kind: "stream", stream: kind.value };
    case "timeline":
      return { kind: "timeline", timeline: kind.value };
    case "recording":
      return { kind: "recording", recording: kind.value };
    case "change":
      return { kind: "change", change: kind.value };
    case "control":
      return { kind: "control", control: kind.value };
    default:
      return undefined;
  }
}
