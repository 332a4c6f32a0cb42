import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { PoseSchema } from "../src/gen/spherule/v1/frame_pb";
import type { Pose } from "../src/gen/spherule/v1/frame_pb";
import type { Vec3 } from "../src/model/facts";
import { turned } from "../src/model/placement";
import type { Placement } from "../src/model/placement";
import { writePose } from "../src/model/poses";

const pivot: Vec3 = [10, 0, 0];

/** A pose that turns by an angle (rad) about the z axis through the pivot, and then moves. */
function spun(angle: number, [x, y, z]: Vec3 = [0, 0, 0], obstacle = 2): Pose {
  const translation = [x + 10 - 10 * Math.cos(angle), y - 10 * Math.sin(angle), z];
  return create(PoseSchema, { obstacle, translation, rotation: [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)] });
}

function written(from: Pose[], to: Pose[], mix: number): Placement {
  const pose: Placement = { turn: [0, 0, 0, 0], move: [0, 0, 0] };
  writePose(pose, { from: { poses: from }, to: { poses: to }, mix }, 2, pivot);
  return pose;
}

/** Where a point of the obstacle is (m). */
function placeOf(pose: Placement, point: Vec3): Vec3 {
  const way = turned(pose, point.map((x, k) => x - pivot[k as 0 | 1 | 2]) as Vec3);
  return way.map((x, k) => x + pose.move[k as 0 | 1 | 2]) as Vec3;
}

function near(actual: Vec3, expected: Vec3): void {
  assert.ok(Math.hypot(...actual.map((x, k) => x - expected[k as 0 | 1 | 2])) < 1e-9, `${actual}, not ${expected}`);
}

test("between two states, an obstacle turns about its pivot, which moves along a line", () => {
  for (const mix of [0, 0.5, 1]) {
    const pose = written([spun(0.4)], [spun(1, [2, 0, 4])], mix);
    const angle = 0.4 + 0.6 * mix;
    near(placeOf(pose, pivot), [10 + 2 * mix, 0, 4 * mix]);
    near(placeOf(pose, [11, 0, 0]), [10 + 2 * mix + Math.cos(angle), Math.sin(angle), 4 * mix]);
    assert.ok(Math.abs(Math.hypot(...pose.turn) - 1) < 1e-12);
  }
});

test("an obstacle turns by the short way, also when the quaternions have opposite signs", () => {
  const to = spun(0.5);
  to.rotation = to.rotation.map((part) => -part);
  near(placeOf(written([spun(-0.1)], [to], 0.5), [11, 0, 0]), [10 + Math.cos(0.2), Math.sin(0.2), 0]);
  near(placeOf(written([spun(3)], [spun(-3)], 0.5), [11, 0, 0]), [9, 0, 0]);
});

test("the pose of an obstacle is found by its number, and without one it is at its place in the scene", () => {
  const others = [spun(1, [5, 5, 5], 0), spun(0, [0, 0, 1]), spun(1, [5, 5, 5], 3)];
  near(placeOf(written(others, others, 1), [11, 0, 0]), [11, 0, 1]);
  near(placeOf(written([], [], 1), [11, 2, 3]), [11, 2, 3]);
});
