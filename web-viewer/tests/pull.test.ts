import assert from "node:assert/strict";
import { test } from "node:test";
import FakeTimers from "@sinonjs/fake-timers";
import type { Outcome } from "../src/connection/link";
import { orbited, poseFrom } from "../src/camera/orbit";
import { rayThrough } from "../src/camera/ray";
import { viewOf } from "../src/camera/view";
import type { Vec3 } from "../src/model/facts";
import { acrossPlane, axesOf, moved } from "../src/tools/plane";
import { Pull } from "../src/tools/pull";

const clock = FakeTimers.install({ toFake: ["setTimeout", "clearTimeout", "performance"] });
const applied = { case: "applied", value: { force: [1, 2, 2] } } as unknown as Outcome;
const refused = { case: "refused", value: {} } as unknown as Outcome;

/** A pull whose commands are answered with `outcome` at once. */
function make(outcome: Outcome): { pull: Pull; sent: [number, Vec3][]; releases: () => number } {
  const sent: [number, Vec3][] = [];
  let releases = 0;
  const send = (sphere: number, point: Vec3): Promise<Outcome> => {
    sent.push([sphere, point]);
    return Promise.resolve(outcome);
  };
  return { pull: new Pull(send, () => (releases += 1)), sent, releases: () => releases };
}

test("points are sent at most twenty times a second, and the newest one last", async () => {
  const { pull, sent, releases } = make(applied);
  pull.grab(7, [0, 0, 1], [0.1, 0, 1]);
  for (let k = 1; k <= 100; k++) {
    pull.drag([0.1 + k / 100, 0, 1]);
    await clock.tickAsync(10);
  }
  assert.ok(sent.length >= 18 && sent.length <= 21, `${sent.length} in a second`);
  assert.deepEqual(pull.force, [1, 2, 2]);
  await clock.tickAsync(100);
  assert.deepEqual(sent.at(-1), [7, [1, 0, 1]], "the sphere keeps its distance from the pointer");
  const count = sent.length;
  await clock.tickAsync(1000);
  assert.ok(sent.length - count >= 3 && sent.length - count <= 5, "the force is asked for");
  assert.equal(pull.letGo(), true);
  assert.equal(releases(), 1);
  const last = sent.length;
  await clock.tickAsync(1000);
  assert.equal(sent.length, last);
  assert.equal(pull.letGo(), false);
});

test("a click grabs nothing, and a refused pull ends", async () => {
  const { pull, sent, releases } = make(refused);
  pull.grab(7, [0, 0, 1], [0, 0, 1]);
  pull.letGo();
  assert.deepEqual([sent.length, releases()], [0, 0]);
  pull.grab(7, [0, 0, 1], [0, 0, 1]);
  pull.drag([1, 0, 1]);
  await clock.tickAsync(500);
  assert.deepEqual([sent.length, releases(), pull.sphere], [1, 0, undefined]);
});

test("the pointer moves in the plane parallel to the picture", () => {
  const insets = { top: 0, right: 0, bottom: 0, left: 0 };
  const extent = { horizontal: 0, vertical: 0, least: Math.tan(Math.PI / 8) };
  const pose = orbited(poseFrom([4, -3, 2], [0.2, 0, 0]), 0.3, 0.2);
  for (const orthographic of [false, true]) {
    const view = viewOf(pose, extent, 800, 600, insets, 50, orthographic);
    const { right, up, away } = axesOf(view);
    const dot = (a: Vec3, b: Vec3): number => a.reduce((sum, part, k) => sum + part * (b[k] ?? 0), 0);
    for (const [a, b, product] of [
      [right, up, 0],
      [right, away, 0],
      [up, away, 0],
      [up, up, 1],
    ] as const) {
      assert.ok(Math.abs(dot(a, b) - product) < 1e-4, `${a} ${b}`);
    }
    assert.ok(up[2] > 0);
    const point: Vec3 = [0.3, 0.1, -0.2];
    const hit = acrossPlane(view, rayThrough(view, 600, 200), point);
    assert.ok(hit);
    const way = hit.map((part, k) => part - (point[k] ?? 0)) as Vec3;
    assert.ok(Math.abs(dot(way, away)) < 1e-4);
    assert.ok(dot(way, right) > 0 && dot(way, up) > 0);
    const back = moved(view, point, [dot(way, right), dot(way, up), 0]);
    hit.forEach((part, k) => assert.ok(Math.abs(part - (back[k] ?? 0)) < 1e-3));
  }
});
