import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { ObstacleSchema } from "../src/gen/spherule/v1/scene_pb";
import type { Obstacle } from "../src/gen/spherule/v1/scene_pb";
import type { Vec3 } from "../src/model/facts";
import { surfaceOf } from "../src/renderer/obstacles";
import { vertexFloats } from "../src/renderer/shapes";

const bounds = { min: [-5, -5, -5] as Vec3, max: [5, 5, 5] as Vec3 };
const grey = [0.5, 0.5, 0.5, 1];

type Vertex = { place: Vec3; normal: Vec3 };

function drawn(shape: Obstacle["shape"]): { vertices: Vertex[]; oneSided: boolean } {
  const { shape: made } = create(ObstacleSchema, { shape });
  const { vertices, oneSided } = surfaceOf({ shape: made, colour: undefined }, grey, bounds);
  const found: Vertex[] = [];
  for (let i = 0; i < vertices.length; i += vertexFloats) {
    const at = (k: number): number => vertices[i + k] ?? NaN;
    found.push({ place: [at(0), at(1), at(2)], normal: [at(3), at(4), at(5)] });
    assert.deepEqual(vertices.slice(i + 6, i + vertexFloats), grey);
  }
  assert.ok(found.length > 0 && found.length % 3 === 0);
  return { vertices: found, oneSided };
}

const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const near = (a: number, b: number): void => assert.ok(Math.abs(a - b) < 1e-9, `${a} instead of ${b}`);

for (const hollow of [false, true]) {
  const sign = hollow ? -1 : 1;

  test(`a ${hollow ? "hollow" : "solid"} sphere is drawn with normals that point to the free side`, () => {
    const centre: Vec3 = [1, 2, 3];
    const value = { $typeName: "spherule.v1.SphereShape" as const, centre, radius: 2, hollow };
    const { vertices, oneSided } = drawn({ case: "sphere", value });
    assert.equal(oneSided, hollow);
    for (const { place, normal } of vertices) {
      near(Math.hypot(...minus(place, centre)), 2);
      near(dot(normal, minus(place, centre)), 2 * sign);
    }
  });

  test(`a ${hollow ? "hollow" : "solid"} cylinder is drawn with a side and two ends`, () => {
    const [from, to]: [Vec3, Vec3] = [
      [1, 0, 0],
      [1, 3, 4],
    ];
    const value = { $typeName: "spherule.v1.CylinderShape" as const, from, to, radius: 0.5, hollow };
    const { vertices } = drawn({ case: "cylinder", value });
    const axis: Vec3 = [0, 0.6, 0.8];
    const seen = new Set<string>();
    for (const { place, normal } of vertices) {
      const way = minus(place, from);
      const along = dot(way, axis);
      const out: Vec3 = [way[0] - along * axis[0], way[1] - along * axis[1], way[2] - along * axis[2]];
      near(Math.hypot(...normal), 1);
      const up = dot(normal, axis);
      if (Math.abs(up) < 0.5) {
        near(Math.hypot(...out), 0.5);
        near(dot(normal, out), 0.5 * sign);
        seen.add("side");
      } else {
        near(along, up * sign > 0 ? 5 : 0);
        seen.add(up * sign > 0 ? "end" : "start");
      }
    }
    assert.equal(seen.size, 3);
  });
}

test("a plane is drawn within the bounds, and its normal has unit length", () => {
  const value = { $typeName: "spherule.v1.Plane" as const, point: [0, 0, 0], normal: [0, 3, 4] };
  const { vertices, oneSided } = drawn({ case: "plane", value });
  assert.ok(oneSided);
  for (const { place, normal } of vertices) {
    near(dot(normal, [0, 0.6, 0.8]), 1);
    near(Math.hypot(...normal), 1);
    near(dot(place, normal), 0);
    assert.ok(place.every((value) => Math.abs(value) <= 5 + 1e-9));
  }
});

test("a box is drawn with six sides", () => {
  const value = { $typeName: "spherule.v1.Box" as const, min: [0, 0, 0], max: [1, 2, 3] };
  const { vertices } = drawn({ case: "box", value });
  assert.equal(vertices.length, 36);
});

test("an obstacle of a shape that this page does not know is not drawn", () => {
  assert.deepEqual(surfaceOf({ shape: { case: undefined }, colour: undefined }, grey, bounds).vertices, []);
});

test("triangles are counter-clockwise as seen from the free side", () => {
  const sphere = { $typeName: "spherule.v1.SphereShape" as const, centre: [0, 0, 0], radius: 1 };
  const cylinder = { $typeName: "spherule.v1.CylinderShape" as const, from: [0, 0, 0], to: [0, 1, 1], radius: 0.5 };
  const plane = { $typeName: "spherule.v1.Plane" as const, point: [0, 0, 0], normal: [1, 0, 1] };
  const box = { $typeName: "spherule.v1.Box" as const, min: [-1, -1, -1], max: [1, 1, 1] };
  const shapes: Obstacle["shape"][] = [
    { case: "plane", value: plane },
    { case: "box", value: box },
  ];
  for (const hollow of [false, true]) {
    shapes.push({ case: "sphere", value: { ...sphere, hollow } }, { case: "cylinder", value: { ...cylinder, hollow } });
  }
  for (const shape of shapes) {
    const { vertices } = drawn(shape);
    for (let i = 0; i < vertices.length; i += 3) {
      const [a, b, c] = vertices.slice(i, i + 3) as [Vertex, Vertex, Vertex];
      const [u, v] = [minus(b.place, a.place), minus(c.place, a.place)];
      const across: Vec3 = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      if (Math.hypot(...across) < 1e-9) continue; // at a pole
      assert.ok(dot(across, a.normal) > 0, `${shape.case}, triangle ${i / 3}`);
    }
  }
});
