import { fromBinary } from "@bufbuild/protobuf";
import { ServerMessageSchema } from "../gen/spherule/v1/control_pb";
import type { ServerMessage } from "../gen/spherule/v1/control_pb";
import type { FromWorker } from "./messages";

type Kind = ServerMessage["kind"];

/** Reads one message of the server. Throws what protobuf throws on bytes that are none. */
export function decode(data: ArrayBuffer): Kind {
  return fromBinary(ServerMessageSchema, new Uint8Array(data)).kind;
}

/** What the page is told as it came. Undefined: it is not for the page, or of a kind that this page does not know. */
export function forPage(kind: Kind): FromWorker | undefined {
  switch (kind.case) {
    case "welcome":
      return { kind: "welcome", welcome: kind.value };
    case "scene":
      return { kind: "scene", facts: kind.value };
    case "settings":
      return { kind: "settings", settings: kind.value };
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
