import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vec3 } from "../src/model/facts";
import { faces, planeInBox } from "../src/renderer/shapes";

test("a slanted plane cuts a box in a polygon with corners on both", () => {
  const points = planeInBox({ point: [0, 0, 0], normal: [0.6, 0, 0.8] }, [-1, -1, -1], [1, 1, 1]);
  assert.equal(points.length, 4);
  for (const [x, y, z] of points) {
    assert.ok(Math.abs(0.6 * x + 0.8 * z) < 1e-9);
    assert.equal(Math.max(Math.abs(x), Math.abs(y), Math.abs(z)), 1);
  }
});

test("a plane through opposite corners cuts a hexagon, one beside the box nothing", () => {
  const n = 1 / Math.sqrt(3);
  const diagonal = { point: [0, 0, 0] as Vec3, normal: [n, n, n] as Vec3 };
  const beside = { point: [0, 0, 9] as Vec3, normal: [0, 0, 1] as Vec3 };
  assert.equal(planeInBox(diagonal, [-1, -1, -1], [1, 1, 1]).length, 6);
  assert.equal(planeInBox(beside, [-1, -1, -1], [1, 1, 1]).length, 0);
});

test("a box has six faces, with corners in counterclockwise order", () => {
  for (const { normal, points } of faces([0, 0, 0], [1, 2, 3])) {
    const [a, b, c] = points;
    assert.ok(a && b && c);
    const u = a.map((value, i) => (b[i] ?? 0) - value);
    const v = a.map((value, i) => (c[i] ?? 0) - value);
    const product = (i: number, j: number): number => (u[i % 3] ?? 0) * (v[j % 3] ?? 0);
    const cross = [0, 1, 2].map((i) => product(i + 1, i + 2) - product(i + 2, i + 1));
    assert.ok(cross.reduce((sum, value, i) => sum + value * (normal[i] ?? 0), 0) > 0);
  }
});
