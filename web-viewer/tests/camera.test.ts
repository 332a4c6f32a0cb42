import assert from "node:assert/strict";
import { test } from "node:test";
import { Camera } from "../src/camera/camera";
import { approached, eyeOf, framing, orbited, panned, poseFrom, zoomed } from "../src/camera/orbit";
import { project, rayThrough } from "../src/camera/ray";
import { freePart } from "../src/camera/free_part";
import { extentOf, tangentPerPixel, viewOf, viewOfPart } from "../src/camera/view";
import type { Vec3 } from "../src/model/facts";
import { pixelOf } from "../src/renderer/frame_uniforms";

const field = { horizontal: 0, vertical: 0, least: Math.tan(Math.PI / 8) }; // of view, 45 degrees
const none = { top: 0, right: 0, bottom: 0, left: 0 };

function close(actual: readonly number[], expected: readonly number[], within = 1e-6): void {
  assert.equal(actual.length, expected.length);
  actual.forEach((value, i) => {
    assert.ok(Math.abs(value - (expected[i] ?? NaN)) < within, `${actual} is not ${expected}`);
  });
}

function corners(min: Vec3, max: Vec3): Vec3[] {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [(i & 1 ? max : min)[0], (i & 2 ? max : min)[1], (i & 4 ? max : min)[2]]);
}

test("a pose made from an eye has that eye", () => {
  const eye: Vec3 = [3, -4, 2];
  close(eyeOf(poseFrom(eye, [1, 1, 0.5])), eye);
});

test("a view straight down has a defined up direction", () => {
  const pose = poseFrom([0, 0, 5], [0, 0, 0]);
  const view = viewOf(pose, field, 100, 100, none, 20);
  for (const value of view.toClip) assert.ok(Number.isFinite(value));
});

test("orbiting keeps the distance and stops at the poles", () => {
  const pose = orbited(poseFrom([5, 0, 0], [0, 0, 0]), 1, 10);
  assert.ok(Math.abs(Math.hypot(...eyeOf(pose)) - 5) < 1e-9);
  assert.ok(pose.elevation < Math.PI / 2);
});

test("panning moves the target in the image plane", () => {
  const pose = poseFrom([0, -5, 0], [0, 0, 0]);
  close(panned(pose, 2, 3).target, [2, 0, 3]);
});

test("zooming keeps the point under the pointer in its place", () => {
  const pose = poseFrom([0, -10, 0], [0, 0, 0]);
  const before = viewOf(pose, field, 800, 600, none, 40);
  const [x, y] = project(before, [2, 0, 1]) ?? [0, 0];
  const after = viewOf(zoomed(pose, 0.5, 2, 1, [0.1, 100]), field, 800, 600, none, 40);
  close(project(after, [2, 0, 1]) ?? [], [x, y], 1e-2);
});

test("zooming stops at its limits", () => {
  const pose = poseFrom([0, -10, 0], [0, 0, 0]);
  assert.equal(zoomed(pose, 1e-9, 0, 0, [0.5, 100]).distance, 0.5);
  assert.equal(zoomed(pose, 1e9, 0, 0, [0.5, 100]).distance, 100);
});

test("a ray through a projected point meets the point", () => {
  const insets = { top: 0, right: 300, bottom: 80, left: 0 };
  const view = viewOf(poseFrom([4, -6, 3], [0, 0, 1]), field, 1280, 720, insets, 30);
  const point: Vec3 = [0.5, 0.7, 0.2];
  const [x, y] = project(view, point) ?? [0, 0];
  const ray = rayThrough(view, x, y);
  const distance = Math.hypot(...point.map((value, i) => value - (view.eye[i] ?? 0)));
  close(
    ray.direction.map((part, i) => (view.eye[i] ?? 0) + part * distance),
    point,
    1e-4,
  );
});

test("the target lies in the middle of the part that the page does not cover", () => {
  const insets = { top: 20, right: 300, bottom: 100, left: 0 };
  const view = viewOf(poseFrom([4, -6, 3], [0, 0, 1]), field, 1280, 720, insets, 30);
  close(project(view, [0, 0, 1]) ?? [], [490, 320], 1e-2);
});

test("an upright canvas shows as much horizontally as a wide one does vertically", () => {
  const pose = poseFrom([0, -10, 0], [0, 0, 0]);
  const wide = viewOf(pose, field, 900, 400, none, 40);
  const upright = viewOf(pose, field, 400, 900, none, 40);
  const up = 200 - (project(wide, [0, 0, 2])?.[1] ?? 0);
  const aside = (project(upright, [2, 0, 0])?.[0] ?? 0) - 200;
  assert.ok(Math.abs(up - aside) < 1e-3, `${up} ${aside}`);
});

test("a point behind the eye has no projection", () => {
  const view = viewOf(poseFrom([0, -10, 0], [0, 0, 0]), field, 100, 100, none, 40);
  assert.equal(project(view, [0, -20, 0]), undefined);
});

test("framing shows every corner of the bounds", () => {
  const [min, max]: [Vec3, Vec3] = [
    [-2, -1, 0],
    [3, 1, 4],
  ];
  const view = viewOf(framing(min, max, 45), field, 1000, 1000, none, 60);
  for (const corner of corners(min, max)) {
    const [x, y] = project(view, corner) ?? [-1, -1];
    assert.ok(x > 0 && x < 1000 && y > 0 && y < 1000, `${x} ${y}`);
  }
});

test("the free part shows every corner of the bounds, whatever its shape", () => {
  const [min, max]: [Vec3, Vec3] = [
    [0, 0, 0],
    [6, 1.5, 1],
  ];
  const pose = framing(min, max, 40);
  const extent = extentOf(pose, 40, min, max);
  const column = { top: 30, right: 270, bottom: 80, left: 8 };
  const sheet = { top: 60, right: 8, bottom: 500, left: 8 };
  for (const insets of [none, column, sheet]) {
    const view = viewOf(pose, extent, 640, 720, insets, 60);
    for (const corner of corners(min, max)) {
      const [x, y] = project(view, corner) ?? [-1, -1];
      assert.ok(x > insets.left && x < 640 - insets.right, `x ${x}`);
      assert.ok(y > insets.top && y < 720 - insets.bottom, `y ${y}`);
    }
  }
});

test("what a scene's camera leaves out of its picture makes the picture no smaller", () => {
  const pose = poseFrom([0, -1, 0], [0, 0, 0]);
  const near = extentOf(pose, 40, [-1.5, -0.5, -0.5], [1.5, 0.5, 0.5]);
  const half = Math.tan(Math.PI / 9);
  close([near.horizontal, near.vertical], [(16 / 9) * half, half]);
  close([tangentPerPixel(near, 1600, 900)], [(2 * half) / 900]);
  const behind = extentOf(pose, 40, [-1, -3, -1], [1, 1, 1]);
  assert.deepEqual(behind, near);
});

test("the free part is the rectangle between the covering boxes in which the picture is largest", () => {
  const panel = { left: 700, top: 16, right: 984, bottom: 600 };
  const legend = { left: 16, top: 500, right: 240, bottom: 600 };
  const square = (width: number, height: number): number => Math.min(width, height);
  const wide = (width: number, height: number): number => Math.min(width / 3, height);
  assert.deepEqual(freePart(1000, 640, [panel, legend], wide), { left: 8, top: 8, right: 308, bottom: 148 });
  assert.deepEqual(freePart(1000, 400, [{ ...legend, top: 100, bottom: 400 }], square), {
    left: 248,
    top: 8,
    right: 8,
    bottom: 8,
  });
  assert.deepEqual(freePart(100, 100, [{ left: 0, top: 0, right: 100, bottom: 100 }], square), none);
});

test("the picture moves to a new free part smoothly, and at once with reduced motion and in a new size", () => {
  const legend = { left: 0, top: 0, right: 392, bottom: 600 };
  const middleOf = (camera: Camera): number => project(camera.view(), [0, 0, 0])?.[0] ?? 0;
  const camera = new Camera();
  camera.resize(1000, 600);
  camera.advance(16);
  close([middleOf(camera)], [500], 1e-2);
  camera.cover([legend]);
  camera.advance(16);
  assert.ok(middleOf(camera) > 510 && middleOf(camera) < 600, `${middleOf(camera)}`);
  camera.advance(16, true);
  close([middleOf(camera)], [696], 1e-2);
  camera.resize(1200, 600);
  camera.advance(16);
  close([middleOf(camera)], [796], 1e-2);
});

test("approaching turns the shorter way", () => {
  const [from, to] = [poseFrom([-5, 1, 0], [0, 0, 0]), poseFrom([-5, -1, 0], [0, 0, 0])];
  assert.ok(eyeOf(approached(from, to, 0.5))[0] < -5);
});

test("with reduced motion, the camera is at its goal at once", () => {
  const [moving, still] = [new Camera(), new Camera()];
  for (const camera of [moving, still]) camera.orbit(100, 50);
  moving.advance(1);
  still.advance(1, true);
  const turned = (camera: Camera): number => camera.pose.azimuth - new Camera().pose.azimuth;
  close([turned(still)], [-0.6]);
  assert.ok(Math.abs(turned(moving)) < 0.1);
});

test("an orthographic view shows the plane of the target as large as a perspective view, with parallel rays", () => {
  const pose = poseFrom([3, -4, 2], [1, 1, 0.5]);
  const insets = { top: 30, right: 200, bottom: 0, left: 0 };
  const perspective = viewOf(pose, field, 800, 500, insets, 20);
  const orthographic = viewOf(pose, field, 800, 500, insets, 20, true);
  const right: Vec3 = [-Math.sin(pose.azimuth), Math.cos(pose.azimuth), 0];
  for (const offset of [-1, 0, 2]) {
    const point = pose.target.map((part, axis) => part + offset * (right[axis] ?? 0)) as Vec3;
    close(project(orthographic, point) ?? [], project(perspective, point) ?? [NaN, NaN], 1e-3);
  }
  for (const [x, y] of [
    [10, 20],
    [700, 400],
  ] as const) {
    const { origin, direction } = rayThrough(orthographic, x, y);
    close(direction, orthographic.forward);
    for (const far of [0, 7]) {
      const point = origin.map((part, axis) => part + far * (direction[axis] ?? 0)) as Vec3;
      close(project(orthographic, point) ?? [], [x, y], 1e-3);
    }
  }
});

test("a tracked point comes to the middle, and stays there while it moves, also after a drag", () => {
  const camera = new Camera();
  camera.resize(1000, 600);
  const placeOf = (point: Vec3): [number, number] | undefined => project(camera.view(), point);
  camera.track([1, 0, 0]);
  for (let k = 0; k < 200; k++) {
    camera.track([1 + 0.01 * k, 0.3, 0]);
    camera.advance(16);
  }
  close(placeOf([2.99, 0.3, 0]) ?? [], [500, 300], 1e-2);
  camera.pan(100, 0);
  camera.advance(16, true);
  close(placeOf([2.99, 0.3, 0]) ?? [], [600, 300], 1);
  const before = placeOf([2.99, 0.3, 0]) ?? [];
  camera.track([-5, 1, 2]);
  close(placeOf([-5, 1, 2]) ?? [], before, 1e-2);
  camera.along(0, 0);
  camera.advance(16, true);
  assert.deepEqual(camera.pose.elevation, 0);
  close(placeOf([-5, 1, 2]) ?? [], before, 40);
  camera.track(undefined);
  camera.reset();
  camera.advance(16, true);
  close(placeOf([0, 0, 0]) ?? [], [500, 300], 1e-2);
});

test("the views of parts of a picture show what the whole picture shows there", () => {
  for (const orthographic of [false, true]) {
    const view = viewOf(poseFrom([4, -6, 3], [0, 0, 1]), field, 800, 500, none, 20, orthographic);
    const part = { x: 0.25, y: 0.5, width: 0.5, height: 0.2 };
    const seen = viewOfPart(view, part);
    for (const point of [
      [0, 0, 1],
      [0.3, 0.1, 1.4],
      [-1, 2, 0.5],
    ] as Vec3[]) {
      const [x = 0, y = 0] = project(view, point) ?? [];
      const [column = 0, row = 0] = project(seen, point) ?? [];
      close([column, row], [x - 200, y - 500 * (1 - 0.7)], 1e-3);
      const ray = rayThrough(seen, column, row);
      close(ray.direction, rayThrough(view, x, y).direction, 1e-6);
    }
    close([pixelOf(seen, 100)], [pixelOf(view, 500)], 1e-12);
  }
});
