import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import { FrameSchema, OrderSchema, Tier } from "../../src/gen/spherule/v1/frame_pb";
import type { Frame, Order } from "../../src/gen/spherule/v1/frame_pb";

/** A chain made by hand after docs/codec.md: frames of up to 64 spheres in epoch 3, order 1. */

type Place = [number, number, number];

const head = (flags: number, spheres: number, number: number, words: number[]): Uint8Array =>
  new Uint8Array(Uint32Array.of(0x5053 | (1 << 16) | (flags << 24), spheres, number, 0, words.length, ...words).buffer);

/** A keyframe of one block. Every value has 32 bits; the base is 0. */
export function keyframe(number: number, places: Place[]): Uint8Array {
  const units = [0xffff, 0, 0, 0, 0, 0, 0, 0, 0, 0]; // header; selectors; base
  for (let axis = 0; axis < 3; axis++) {
    for (let k = 0; k < 64; k++) {
      const q = (places[Math.min(k, places.length - 1)] as Place)[axis] as number;
      const value = (q << 1) ^ (q >> 31);
      units.push(value & 0xffff, value >>> 16);
    }
  }
  const words = units.flatMap((unit, i) => (i % 2 === 0 ? [unit | ((units[i + 1] ?? 0) << 16)] : []));
  return head(1, places.length, number, [1, ...words]);
}

/** A delta frame in which nothing moves. */
export function still(number: number, spheres: number): Uint8Array {
  return head(0, spheres, number, [0]);
}

export function frameOf(spb: Uint8Array, fields: MessageInitShape<typeof FrameSchema> = {}): Frame {
  const times = { sequence: 7n, step: 120n, simTime: 2 };
  return create(FrameSchema, { ...times, epoch: 3, tier: Tier.NORMAL, order: 1, quantum: 0.5, spb, ...fields });
}

export function orderOf(ids: number[], fields: MessageInitShape<typeof OrderSchema> = {}): Order {
  const bytes = ids.flatMap((id) => [id & 255, (id >> 8) & 255, id >> 16]);
  return create(OrderSchema, { epoch: 3, number: 1, ids: Uint8Array.from(bytes), ...fields });
}

/** A delta frame, without turns, that moves each of up to 64 spheres by the same vector. */
export function moved(number: number, spheres: number, by: Place): Uint8Array {
  const base = by.map((q) => q & 0x3ff) as Place; // small steps only
  const packed = base[0] | (base[1] << 10) | (base[2] << 20);
  const units = [0x0003, 0, 0, 0, packed & 0xffff, packed >>> 16]; // runs with base, no widths, predictor previous
  const words = [0, 2, 4].map((k) => (units[k] as number) | ((units[k + 1] as number) << 16));
  return head(0, spheres, number, [1, ...words.map((word) => word >>> 0)]);
}
