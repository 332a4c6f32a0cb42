import { fromBinary } from "@bufbuild/protobuf";
import { ServerMessageSchema } from "../gen/spherule/v1/control_pb";
import type { Frame } from "../gen/spherule/v1/frame_pb";
import type { FromWorker } from "./messages";

/** Gives a buffer of at least this many bytes, new or used before. */
export type Take = (bytes: number) => ArrayBuffer;

/**
 * Reads one message of the server. Throws what protobuf throws on bytes that are none, and an Error on a frame whose
 * payload is shorter than its count. Undefined: a kind that this page does not know.
 */
export function decode(data: ArrayBuffer, arrival: number, take: Take): FromWorker | undefined {
  const { kind } = fromBinary(ServerMessageSchema, new Uint8Array(data));
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
    case "frame": {
      const frame = kind.value;
      return {
        kind: "frame",
        frame: {
          sequence: Number(frame.sequence),
          epoch: frame.epoch,
          step: Number(frame.step),
          simTime: frame.simTime,
          count: frame.count,
          positions: positionsOf(frame, take),
          arrival,
          bytes: data.byteLength,
          status: frame.status,
        },
      };
    }
    default:
      return undefined;
  }
}

function positionsOf(frame: Frame, take: Take): Uint16Array {
  const codec = frame.states?.codec;
  if (codec?.case !== "packed16") throw new Error(`frame ${frame.sequence}: states in a form that this page cannot read`);
  const packed = codec.value.positions;
  const bytes = frame.count * 6;
  if (packed.byteLength < bytes) {
    throw new Error(`frame ${frame.sequence}: ${packed.byteLength} bytes for ${frame.count} spheres, which take ${bytes}`);
  }
  // The payload lies anywhere in the message; a Uint16Array must start at an even address.
  const positions = new Uint16Array(take(bytes), 0, frame.count * 3);
  new Uint8Array(positions.buffer, 0, bytes).set(packed.subarray(0, bytes));
  return positions;
}
