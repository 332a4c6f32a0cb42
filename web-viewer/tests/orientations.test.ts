import assert from "node:assert/strict";
import { test } from "node:test";
import { Orientations } from "../src/codec/orientations";

type Quaternion = [x: number, y: number, z: number, w: number];

function quaternionAt({ values }: Orientations, place: number): Quaternion {
  const [x = NaN, y = NaN, z = NaN] = values.subarray(3 * place, 3 * place + 3);
  const square = x * x + y * y + z * z;
  return [2 * x, 2 * y, 2 * z, 1 - square].map((part) => part / (1 + square)) as Quaternion;
}

function product([ax, ay, az, aw]: Quaternion, [bx, by, bz, bw]: Quaternion): Quaternion {
  return [
    aw * bx + bw * ax + ay * bz - az * by,
    aw * by + bw * ay + az * bx - ax * bz,
    aw * bz + bw * az + ax * by - ay * bx,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/** The angle (rad) from one orientation to another. */
function angleBetween(a: Quaternion, b: Quaternion): number {
  const [x, y, z, w] = product(a, [-b[0], -b[1], -b[2], b[3]]);
  return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
}

/** The value of a code of docs/codec.md, in units. */
const valueOf = (code: number): number => {
  const k = Math.abs(code);
  return k === 0 ? 0 : Math.sign(code) * (2 ** Math.floor(k / 16) * (1 + ((k % 16) + 0.5) / 16) - 1);
};

test("ten seconds of a constant spin turn a sphere by the right angle about the right axis", () => {
  const unit = 0.5; // rad/s
  const codes = [
    [0, 0, 40],
    [-33, 12, 7],
    [90, -90, 45], // more than half a turn from one frame to the next
    [1, 0, -1],
    [0, 0, 0],
  ];
  const ids = Uint32Array.of(3, 0, 4, 1, 2);
  const orientations = new Orientations(codes.length);
  const units = Int32Array.from(codes.flat());
  const before = codes.map((_, k) => quaternionAt(orientations, ids[k] as number));
  for (let frame = 0; frame <= 300; frame++) orientations.turn(units, ids, unit, 5 + frame / 30);
  codes.forEach((parts, k) => {
    const spin = parts.map((code) => unit * valueOf(code));
    const speed = Math.hypot(...spin);
    const turn = speed > 0 ? spin.map((part) => (Math.sin(5 * speed) * part) / speed) : [0, 0, 0];
    const expected = product([...turn, Math.cos(5 * speed)] as Quaternion, before[k] as Quaternion);
    const error = angleBetween(expected, quaternionAt(orientations, ids[k] as number));
    assert.ok(error < 1e-4, `sphere ${k}: off by ${error} rad`);
  });
});

test("time that does not pass, or goes back, turns nothing, and neither does a spin that is not finite", () => {
  const orientations = new Orientations(2);
  const before = [...orientations.values];
  const units = Int32Array.of(20, 0, 0, 2048, -2048, 0);
  orientations.turn(units, Uint32Array.of(0, 1), 1, 3);
  orientations.turn(units, Uint32Array.of(0, 1), 1, 3);
  orientations.turn(units, Uint32Array.of(0, 1), 1, 1);
  assert.deepEqual([...orientations.values], before);
  orientations.turn(units, Uint32Array.of(0, 1), 1, 2);
  assert.notDeepEqual([...orientations.values.slice(0, 3)], before.slice(0, 3));
  assert.deepEqual([...orientations.values.slice(3)], before.slice(3));
});
