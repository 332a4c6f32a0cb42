import assert from "node:assert/strict";
import { test } from "node:test";
import { Backoff } from "../src/connection/backoff";
import { ladder, QualityControl } from "../src/renderer/quality";
import { faces, planeInBox } from "../src/renderer/shapes";
import { bytesPerSecond, count, figure, length } from "../src/ui/format";
import { presetOf } from "../src/ui/gravity";

test("waits double up to their limit and start over after a success", () => {
  const backoff = new Backoff(100, 1000, () => 0);
  assert.deepEqual([1, 2, 3, 4, 5, 6].map(() => backoff.next()), [100, 200, 400, 800, 1000, 1000]);
  backoff.reset();
  assert.equal(backoff.next(), 100);
});

test("waits are shortened at random by at most a quarter", () => {
  assert.equal(new Backoff(100, 1000, () => 1).next(), 75);
});

test("quality goes down after a run of slow pictures, and only then", () => {
  const control = new QualityControl("auto", false);
  for (let i = 0; i < 100; i++) control.took(i % 3 ? 16 : 50);
  assert.equal(control.quality, ladder[0]);
  for (let i = 0; i < 17; i++) control.took(50);
  assert.equal(control.quality, ladder[1]);
});

test("a quality that was asked for stays, and software starts light", () => {
  const control = new QualityControl("full", true);
  for (let i = 0; i < 200; i++) control.took(500);
  assert.equal(control.quality, ladder[0]);
  assert.equal(new QualityControl("auto", true).quality.occlusion, false);
});

test("a slanted plane cuts a box in a polygon whose corners lie on both", () => {
  const points = planeInBox({ point: [0, 0, 0], normal: [0.6, 0, 0.8], colour: undefined }, [-1, -1, -1], [1, 1, 1]);
  assert.equal(points.length, 4);
  for (const [x, y, z] of points) {
    assert.ok(Math.abs(0.6 * x + 0.8 * z) < 1e-9);
    assert.equal(Math.max(Math.abs(x), Math.abs(y), Math.abs(z)), 1);
  }
});

test("a plane through opposite corners cuts a hexagon, one beside the box nothing", () => {
  const n = 1 / Math.sqrt(3);
  assert.equal(planeInBox({ point: [0, 0, 0], normal: [n, n, n], colour: undefined }, [-1, -1, -1], [1, 1, 1]).length, 6);
  assert.equal(planeInBox({ point: [0, 0, 9], normal: [0, 0, 1], colour: undefined }, [-1, -1, -1], [1, 1, 1]).length, 0);
});

test("a box has six faces, each with its corners in the order that its normal says", () => {
  for (const { normal, points } of faces([0, 0, 0], [1, 2, 3])) {
    const [a, b, c] = points;
    assert.ok(a && b && c);
    const u = a.map((value, i) => (b[i] ?? 0) - value);
    const v = a.map((value, i) => (c[i] ?? 0) - value);
    const cross = [0, 1, 2].map((i) => (u[(i + 1) % 3] ?? 0) * (v[(i + 2) % 3] ?? 0) - (u[(i + 2) % 3] ?? 0) * (v[(i + 1) % 3] ?? 0));
    assert.ok(cross.reduce((sum, value, i) => sum + value * (normal[i] ?? 0), 0) > 0);
  }
});

test("figures read well", () => {
  assert.equal(count(1234567), "1\u202f234\u202f567");
  assert.deepEqual([0, 1, 0.5, 12.34, 1234, -0.0123, 99999].map(figure), ["0", "1", "0.5", "12.3", "1234", "−0.0123", "99999"]);
  assert.deepEqual([0.05, 1.5, 0.0023].map(length), ["5 cm", "1.5 m", "2.3 mm"]);
  assert.deepEqual([53_000, 1_234_000].map(bytesPerSecond), ["53 kB/s", "1.23 MB/s"]);
});

test("a preset is known by its numbers", () => {
  assert.equal(presetOf([0, 0, -1.62]), "Moon");
  assert.equal(presetOf([0, 0, -1.7]), "Own");
});
