import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { PoseSchema } from "../src/gen/spherule/v1/frame_pb";
import type { Obstacle, Vec3 } from "../src/model/facts";
import { dropAbove, placeOnRay } from "../src/tools/drop_place";

const box = { min: [-1, -1, 0] as Vec3, max: [1, 1, 2] as Vec3 };
const shaped = (shape: unknown): Obstacle => ({ shape: shape as Obstacle["shape"], colour: undefined });
const still = { poses: [] };
const down = { origin: [0.3, 0, 5] as Vec3, direction: [0, 0, -1] as Vec3 };

function close(actual: readonly number[], expected: readonly number[], within: number): void {
  const right = actual.every((value, k) => Math.abs(value - (expected[k] ?? NaN)) < within);
  assert.ok(right, `${actual}, not ${expected}`);
}

test("a ray meets the far side of the bounds, or an obstacle before it", () => {
  close(placeOnRay({ ...box, obstacles: [] }, down, still), [0.3, 0, 0], 1e-9);
  const cases: [unknown, number][] = [
    [{ case: "plane", value: { point: [0, 0, 0.5], normal: [0, 0, 3] } }, 0.5],
    [{ case: "box", value: { min: [0, -1, 0], max: [1, 1, 0.7] } }, 0.7],
    [{ case: "box", value: { min: [0.5, -1, 0], max: [1, 1, 0.7] } }, 0],
    [{ case: "sphere", value: { centre: [0.3, 0, 0.5], radius: 0.25, hollow: false } }, 0.75],
    [{ case: "sphere", value: { centre: [0.3, 0, 1], radius: 0.9, hollow: true } }, 1 - Math.sqrt(0.81)],
    [{ case: "cylinder", value: { from: [0.3, 0, 0], to: [0.3, 0, 0.4], radius: 0.2, hollow: false } }, 0.4],
    [{ case: "cylinder", value: { from: [0.3, 0, 0], to: [0.3, 0, 0.4], radius: 0.2, open: true } }, 0],
    [{ case: "cylinder", value: { from: [0, 0, 0.7], to: [1, 0, 0.7], radius: 0.2, open: true } }, 0.9],
    [{ case: "cone", value: { from: [0, 0, 0], to: [0, 0, 0.6], fromRadius: 0.6, toRadius: 0 } }, 0.3],
    [{ case: "cone", value: { from: [0, 0, 0], to: [0, 0, 0.6], fromRadius: 0, toRadius: 0.6, open: true } }, 0.3],
    [{ case: "capsule", value: { from: [0.3, -1, 0.3], to: [0.3, 1, 0.3], radius: 0.2, hollow: false } }, 0.5],
    [{ case: "disc", value: { centre: [0, 0, 0.5], normal: [-1, 0, 1], radius: 1, hole: 0.1 } }, 0.8],
    [{ case: "disc", value: { centre: [0, 0, 0.5], normal: [0, 0, 1], radius: 1, hole: 0.4 } }, 0],
    [{ case: "box", value: { min: [-1, -1, 0.2], max: [1, 1, 1.5], hollow: true } }, 0.2],
  ];
  for (const [shape, height] of cases) {
    close(placeOnRay({ ...box, obstacles: [shaped(shape)] }, down, still), [0.3, 0, height], 2e-3);
  }
});

test("a ray meets an obstacle that moves where it is in the state", () => {
  const bar = { case: "box", value: { min: [-0.9, -0.1, 0.2], max: [0.9, 0.1, 0.4] } };
  const moving = { ...shaped(bar), pivot: [0, 0, 0.3] as Vec3 };
  // A translation, after a quarter of a turn about the y axis: the bar stands upright.
  const [rotation, translation] = [
    [0, Math.SQRT1_2, 0, Math.SQRT1_2],
    [0.3, 0, 1],
  ];
  const pose = create(PoseSchema, { obstacle: 1, rotation, translation });
  const obstacles = [shaped({ case: "sphere", value: { centre: [0, 0, 0], radius: 0.1, hollow: false } }), moving];
  const ray = { origin: [0.55, 0, 5] as Vec3, direction: [0, 0, -1] as Vec3 };
  close(placeOnRay({ ...box, obstacles }, ray, still), [0.55, 0, 0.4], 2e-3);
  close(placeOnRay({ ...box, obstacles }, ray, { poses: [pose] }), [0.55, 0, 1.9], 2e-3);
});

test("spheres are dropped above the place, against gravity", () => {
  for (const [gravity, axis, side] of [
    [[0, 0, -9.81], 2, 1],
    [[0, 0, 0], 2, 1],
    [[5, 1, 0], 0, -1],
  ] as const) {
    const place: Vec3 = [0.1, 0.2, 1];
    const { min, max, count, radius } = dropAbove(box, gravity, place, 0.1, 10, 0.05);
    assert.deepEqual([count, radius], [10, 0.05]);
    const nearest = side > 0 ? (min[axis] ?? 0) : (max[axis] ?? 0);
    assert.ok(Math.abs((nearest - place[axis]) * side - 0.155) < 1e-9, `${min} ${max}`);
    const volume = min.reduce((product, low, k) => product * ((max[k] ?? 0) - low), 1);
    assert.ok(10 * (4 / 3) * Math.PI * 0.05 ** 3 <= 0.2 * volume, "room for random places");
  }
});

test("the region for dropped spheres stays in the bounds", () => {
  for (const place of [
    [1, 1, 2],
    [-1, -1, 0],
    [0, 0, 1.99],
  ] as Vec3[]) {
    const { min, max } = dropAbove(box, [0, 0, -9.81], place, 0, 100, 0.1);
    min.forEach((low, k) => assert.ok(low >= (box.min[k] ?? 0) + 0.1 && (max[k] ?? 0) <= (box.max[k] ?? 0) - 0.1));
  }
});
