import { create, toBinary } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { decode } from "../src/connection/decode";
import { SceneFactsSchema, ServerMessageSchema } from "../src/gen/spherule/v1/control_pb";
import type { ServerMessage } from "../src/gen/spherule/v1/control_pb";
import { FrameSchema } from "../src/gen/spherule/v1/frame_pb";
import { factsOf, radiusOf } from "../src/scene/facts";
import { highSpeed, positionOf, speedOf } from "../src/scene/positions";

function bytesOf(kind: ServerMessage["kind"]): ArrayBuffer {
  return toBinary(ServerMessageSchema, create(ServerMessageSchema, { kind })).slice().buffer;
}

function frameBytes(count: number, positions: Uint8Array): ArrayBuffer {
  const codec = { case: "packed16" as const, value: { positions } };
  return bytesOf({ case: "frame", value: create(FrameSchema, { sequence: 7n, epoch: 3, step: 120n, simTime: 2, count, states: { codec } }) });
}

const take = (bytes: number): ArrayBuffer => new ArrayBuffer(bytes);

function decodedFrame(count: number, units: number[]) {
  const padded = new Uint8Array(64 * 6);
  const view = new DataView(padded.buffer);
  units.forEach((unit, i) => view.setUint16(2 * i, unit, true));
  const message = decode(frameBytes(count, padded), 1234, take);
  assert.equal(message?.kind, "frame");
  assert.ok(message?.kind === "frame");
  return message.frame;
}

test("a frame gives its units in id order, without the padding", () => {
  const frame = decodedFrame(2, [1, 2, 3, 65535, 0x0102, 0]);
  assert.deepEqual([...frame.positions], [1, 2, 3, 65535, 0x0102, 0]);
  assert.deepEqual([frame.sequence, frame.epoch, frame.step, frame.simTime, frame.arrival], [7, 3, 120, 2, 1234]);
});

test("a larger used buffer is taken without showing what it held", () => {
  const used = new Uint8Array(600).fill(255).buffer;
  const padded = new Uint8Array(64 * 6);
  const message = decode(frameBytes(1, padded), 0, () => used);
  assert.ok(message?.kind === "frame");
  assert.deepEqual([...message.frame.positions], [0, 0, 0]);
});

test("a frame with fewer bytes than its count is refused with both figures", () => {
  assert.throws(() => decode(frameBytes(2, new Uint8Array(11)), 0, take), /11 bytes for 2 spheres, which take 12/);
});

test("a frame in an unknown form is refused", () => {
  const bytes = bytesOf({ case: "frame", value: create(FrameSchema, { count: 1 }) });
  assert.throws(() => decode(bytes, 0, take), /cannot read/);
});

test("bytes that are no message are refused", () => {
  assert.throws(() => decode(new Uint8Array([255, 255, 255]).buffer, 0, take));
});

test("a message of no known kind is left alone", () => {
  assert.equal(decode(new ArrayBuffer(0), 0, take), undefined);
});

const facts = factsOf(
  create(SceneFactsSchema, {
    epoch: 3,
    count: 2,
    boundsMin: [0, 0, 0],
    boundsMax: [1, 1, 1],
    radii: new Uint8Array(new Float32Array([0.5, 0.25]).buffer),
    grid: { originX: -1, originY: -2, originZ: -3, quantum: 0.5 },
    obstacles: [{ shape: { case: "plane", value: { point: [0, 0, 0], normal: [0, 3, 4] } } }],
  }),
);

test("a place is the grid's origin and a quantum per unit", () => {
  assert.deepEqual(positionOf(facts, decodedFrame(2, [0, 0, 0, 2, 4, 6]), 1), [0, 0, 0]);
});

test("radii of their own come as float32; normals become unit vectors", () => {
  assert.deepEqual([radiusOf(facts, 0), radiusOf(facts, 1)], [0.5, 0.25]);
  assert.deepEqual(facts.radiusRange, [0.25, 0.5]);
  assert.deepEqual(facts.planes[0]?.normal, [0, 0.6, 0.8]);
});

test("speed is the way between two states over their time", () => {
  const from = decodedFrame(2, [0, 0, 0, 0, 0, 0]);
  const to = { ...decodedFrame(2, [0, 0, 0, 6, 8, 0]), simTime: 4 };
  assert.equal(speedOf(facts, from, to, 1), 2.5);
  assert.equal(speedOf(facts, from, to, 0), 0);
  assert.equal(speedOf(facts, from, from, 1), 0);
});

test("the high speed leaves the fastest few out", () => {
  const many = Array.from({ length: 64 }, (_, id) => [0, 0, id === 63 ? 1000 : id]).flat();
  const from = decodedFrame(64, many.map(() => 0));
  const to = { ...decodedFrame(64, many), simTime: 2.5 };
  assert.equal(highSpeed(facts, from, to), 61);
});
