import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { BufferPool } from "../src/connection/buffer_pool";
import { Frames } from "../src/connection/frames";
import { idsOf, scatter } from "../src/connection/order";
import type { Positions } from "../src/columns";
import { Quantity, Tier } from "../src/gen/spherule/v1/frame_pb";
import type { Frame } from "../src/gen/spherule/v1/frame_pb";
import { frameOf, keyframe, orderOf, still } from "./support/chain";

const ends: [number, number, number][] = [
  [1, 2, 3],
  [-4, 5, 600],
  [7, 8, -9],
];
const first = (fields = {}): Frame => frameOf(keyframe(1, ends), { count: 3, ...fields });
const next = (number: number, fields = {}): Frame => frameOf(still(number, 3), { count: 3, ...fields });

function begun(buffers = new BufferPool()): Frames {
  const frames = new Frames(buffers);
  frames.setScene(3, 3);
  frames.setOrder(orderOf([2, 0, 1]));
  return frames;
}

function columnOf(frames: Frames, frame: Frame): Positions {
  const decoded = frames.decode(frame);
  assert.ok(decoded.kind === "state", decoded.kind);
  return decoded.content.columns.position;
}

const positionsOf = (frames: Frames, frame: Frame): Int32Array => columnOf(frames, frame).values;

test("a frame is decoded to whole numbers of its quantum, in id order", () => {
  const frames = begun();
  const units = [-4, 5, 600, 7, 8, -9, 1, 2, 3];
  assert.deepEqual([...positionsOf(frames, first())], units);
  const { values, quantum, quanta, turns } = columnOf(frames, next(2));
  assert.deepEqual([...values], units);
  assert.deepEqual([quantum, quanta, turns], [0.5, [0.5, 0.5, 0.5], [0, 0, 0]]);
});

test("speeds are decoded from their codes, in id order, and end with the chain that has them", () => {
  const codes: [number, number, number][] = [
    [0, 0, 0],
    [1, 0, 0], // 1 + speed / unit is from 1 + 1/64 to 1 + 2/64
    [64 * 10, 0, 0], // from 2^10 to 2^10 (1 + 1/64)
  ];
  const speeds = { quantity: Quantity.SPEED, unit: 0.01 };
  const frames = begun();
  const decoded = frames.decode(first({ ...speeds, values: keyframe(1, codes) }));
  assert.ok(decoded.kind === "state");
  const found = [...(decoded.content.columns.value?.values ?? [])];
  const expected = [0.01 * (1.5 / 64), 0.01 * (1024 * (1 + 0.5 / 64) - 1), 0];
  assert.deepEqual(found, expected.map(Math.fround));
  const after = frames.decode(next(2, { ...speeds, values: still(2, 3) }));
  assert.ok(after.kind === "state");
  assert.deepEqual([...(after.content.columns.value?.values ?? [])], found);
  assert.equal(after.content.columns.value?.quantity, Quantity.SPEED);
  const energies = { ...speeds, quantity: Quantity.ENERGY, values: still(3, 3) };
  assert.equal(frames.decode(next(3, energies)).kind, "behind", "another quantity begins with a keyframe");
  frames.decode(first({ ...speeds, values: keyframe(1, codes) }));
  assert.equal(frames.decode(next(3)).kind, "behind", "another chain begins with a keyframe");
  const without = frames.decode(first());
  assert.ok(without.kind === "state");
  assert.equal(without.content.columns.value, undefined);
  assert.equal(frames.decode(next(2, { ...speeds, values: still(2, 3) })).kind, "behind");
});

test("frames with angular velocities have orientations, which begin anew in another epoch", () => {
  const spins: [number, number, number][] = [
    [40, 0, 0],
    [0, 0, 0],
    [0, -40, 0],
  ];
  const frames = begun();
  const turnsOf = (frame: Frame): number[] => {
    const decoded = frames.decode(frame);
    assert.ok(decoded.kind === "state", decoded.kind);
    return [...(decoded.content.columns.turn?.values ?? [])];
  };
  const begin = { spinUnit: 1, spins: keyframe(1, spins) };
  const initial = turnsOf(first(begin));
  assert.equal(initial.length, 9);
  const turned = turnsOf(next(2, { spinUnit: 1, spins: still(2, 3), simTime: 2.5 }));
  const changed = [2, 0, 1].map((place) => turned[3 * place] !== initial[3 * place]); // in frame order
  assert.deepEqual(changed, [true, false, true]);
  assert.deepEqual(turnsOf(first()), [], "no orientations without angular velocities");
  turnsOf(first(begin));
  frames.setScene(4, 3);
  frames.setOrder(orderOf([2, 0, 1], { epoch: 4 }));
  assert.deepEqual(turnsOf(first({ ...begin, epoch: 4, simTime: 9 })), initial);
});

test("the golden frames are decoded in the given order", () => {
  const golden = (name: string) => new Uint8Array(readFileSync(path.join("..", "tests", "golden", "codec", name)));
  const count = 583;
  const ids = Array.from({ length: count }, (_, k) => (k * 100) % count);
  const frames = new Frames(new BufferPool());
  frames.setScene(3, count);
  frames.setOrder(orderOf(ids));
  let positions: Int32Array = new Int32Array(0);
  for (let k = 0; k < 8; k++) {
    positions = positionsOf(frames, frameOf(golden(`frame-${k}.spb`), { count, quantum: 0.25 }));
  }
  const units = new Int32Array(golden("positions.i32").buffer);
  ids.forEach((id, k) => {
    for (let axis = 0; axis < 3; axis++) {
      assert.equal(positions[3 * id + axis], units[3 * k + axis]);
    }
  });
});

test("a larger used buffer is reused, and its old content is not visible", () => {
  const buffers = new BufferPool();
  buffers.release(new Uint8Array(600).fill(255).buffer);
  const positions = positionsOf(begun(buffers), first());
  assert.deepEqual([positions.length, positions.buffer.byteLength, positions[0]], [9, 600, -4]);
});

test("frames of another epoch or order are ignored", () => {
  const frames = begun();
  assert.equal(frames.decode(first({ epoch: 2 })).kind, "foreign");
  assert.equal(frames.decode(first({ order: 2 })).kind, "foreign");
  positionsOf(frames, first());
  assert.equal(frames.decode(next(2, { order: 2 })).kind, "foreign");
  frames.setScene(4, 3);
  assert.equal(frames.decode(first({ epoch: 4 })).kind, "foreign", "the order is of the previous epoch");
  frames.setOrder(orderOf([0, 1, 2]));
  assert.equal(frames.decode(first({ epoch: 4 })).kind, "foreign", "an order of another epoch");
});

test("a keyframe starts another chain, and ends the previous one", () => {
  const frames = begun();
  positionsOf(frames, first());
  assert.equal(frames.decode(next(2, { tier: Tier.FINE, quantum: 0.125 })).kind, "behind");
  const fine = columnOf(frames, first({ tier: Tier.FINE, quantum: 0.125 }));
  assert.deepEqual([fine.values[0], fine.quanta], [-4, [0.125, 0.125, 0.125]]);
  positionsOf(frames, next(2, { tier: Tier.FINE, quantum: 0.125 }));
  assert.equal(frames.decode(next(3)).kind, "behind");
  assert.equal(frames.decode(next(3, { tier: Tier.FINE, quantum: 0.125 })).kind, "behind", "a lost chain stays lost");
});

test("a new order starts with a keyframe", () => {
  const frames = begun();
  positionsOf(frames, first());
  frames.setOrder(orderOf([0, 1, 2], { number: 2 }));
  assert.equal(frames.decode(next(2, { order: 2 })).kind, "behind");
  assert.deepEqual([...positionsOf(frames, first({ order: 2 }))].slice(0, 3), [1, 2, 3]);
});

test("a new connection starts with a keyframe", () => {
  const frames = begun();
  positionsOf(frames, first());
  frames.reset();
  frames.setScene(3, 3);
  frames.setOrder(orderOf([2, 0, 1]));
  assert.equal(frames.decode(next(2)).kind, "behind");
  positionsOf(frames, first());
});

test("a new epoch with more spheres gets a new decoder", () => {
  const frames = begun();
  positionsOf(frames, first());
  frames.setScene(4, 4);
  frames.setOrder(orderOf([3, 2, 1, 0], { epoch: 4 }));
  const more = frameOf(keyframe(9, [...ends, [1, 1, 1]]), { epoch: 4, count: 4 });
  assert.deepEqual([...positionsOf(frames, more)].slice(0, 3), [1, 1, 1]);
});

test("a malformed frame ends the chain, and a keyframe restores it", () => {
  const frames = begun();
  positionsOf(frames, first());
  assert.throws(() => frames.decode(next(3)), /is number 3, which does not follow 1/);
  assert.equal(frames.decode(next(2)).kind, "behind");
  positionsOf(frames, first());
  assert.throws(() => frames.decode(first({ count: 4 })), /frame 7: has 4 spheres, expected 3/);
  assert.throws(() => frames.decode(first({ quantum: 0 })), /frame 7: has no quantum/);
  assert.throws(() => frames.decode(first({ quantum: Infinity })), /frame 7: has no quantum/);
  assert.throws(() => frames.decode(frameOf(keyframe(1, ends).subarray(0, 40), { count: 3 })), /frame, /);
  assert.equal(frames.decode(frameOf(new Uint8Array(0), { count: 3 })).kind, "behind");
  positionsOf(frames, first());
});

test("an order that is no permutation of the ids is refused", () => {
  const refused = (ids: number[], reason: RegExp) => assert.throws(() => idsOf(orderOf(ids).ids, 3), reason);
  assert.deepEqual([...idsOf(orderOf([2, 0, 1]).ids, 3)], [2, 0, 1]);
  refused([0, 1], /order: has 6 bytes, expected 9 for 3 spheres/);
  refused([0, 1, 2, 3], /order: has 12 bytes, expected 9 for 3 spheres/);
  refused([0, 3, 1], /order: sphere 1 has id 3, but there are only 3 spheres/);
  refused([0, 1, 0x010002], /order: sphere 2 has id 65538/);
  refused([2, 0, 2], /order: id 2 occurs twice/);
  assert.throws(() => idsOf(new Uint8Array(8), 3), /order: has 8 bytes/);
});

test("values are scattered from frame order to id order", () => {
  const units = Int32Array.of(1, 2, 3, 4, 5, 6);
  const values = new Int32Array(6);
  scatter(units, Uint32Array.of(1, 0), values);
  assert.deepEqual([...values], [4, 5, 6, 1, 2, 3]);
});

test("after a refused order, frames are ignored until a valid order arrives", () => {
  const frames = begun();
  positionsOf(frames, first());
  assert.throws(() => frames.setOrder(orderOf([0, 0, 0], { number: 2 })));
  assert.equal(frames.decode(first({ order: 1 })).kind, "foreign");
  assert.equal(frames.decode(first({ order: 2 })).kind, "foreign");
  frames.setOrder(orderOf([2, 0, 1], { number: 3 }));
  positionsOf(frames, first({ order: 3 }));
});

test("a periodic axis has its own quantum", () => {
  const frames = new Frames(new BufferPool());
  frames.setScene(3, 64, [25, 0, 0]);
  frames.setOrder(orderOf(Array.from({ length: 64 }, (_, k) => k)));
  const words = [0x05015053, 64, 1, 0, 100, 0, 0, 6, 1, 0x000f, 0, 49, 6, 0xfffffff9];
  const spb = new Uint8Array(Uint32Array.from(words).buffer);
  const { values, quanta, turns } = columnOf(frames, frameOf(spb, { count: 64 }));
  assert.deepEqual([...values.subarray(0, 3)], [49, 6, -7]);
  assert.deepEqual(
    [quanta, turns],
    [
      [1 / 4, 1 / 2, 1 / 2],
      [100, 0, 0],
    ],
  );
});
