import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { MeshFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { ObstacleSchema } from "../src/gen/spherule/v1/obstacle_pb";
import type { Obstacle } from "../src/gen/spherule/v1/obstacle_pb";
import type { Vec3 } from "../src/model/facts";
import { placementOf } from "../src/model/placement";
import { surfaceOf } from "../src/renderer/obstacles";
import { vertexFloats } from "../src/renderer/shapes";

const bounds = { min: [-5, -5, -5] as Vec3, max: [5, 5, 5] as Vec3 };
const grey = [0.5, 0.5, 0.5, 1];

type Vertex = { place: Vec3; normal: Vec3 };

type Place = MessageInitShape<typeof ObstacleSchema>;

function drawn(shape: Obstacle["shape"], place: Place = {}): { vertices: Vertex[]; oneSided: boolean } {
  const made = create(ObstacleSchema, { ...place, shape });
  const placement = placementOf(made);
  const { vertices, oneSided } = surfaceOf({ shape: made.shape, placement, colour: undefined }, grey, bounds);
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
    const value = { $typeName: "spherule.v1.CylinderShape" as const, from, to, radius: 0.5, hollow, open: false };
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

/** Of each vertex: its distance from an axis and along it, and the parts of its normal in these directions. */
function around(vertices: Vertex[], from: Vec3, axis: Vec3): [number, number, number, number][] {
  return vertices.map(({ place, normal }) => {
    const way = minus(place, from);
    const along = dot(way, axis);
    const out: Vec3 = [way[0] - along * axis[0], way[1] - along * axis[1], way[2] - along * axis[2]];
    const distance = Math.hypot(...out);
    return [distance, along, distance > 0 ? dot(normal, out) / distance : 0, dot(normal, axis)];
  });
}

const ends = { from: [1, 0, 0], to: [1, 3, 4] };
const axis: Vec3 = [0, 0.6, 0.8];

test("a cone is drawn with a slanted side, and an open one without ends, seen from inside", () => {
  const value = { $typeName: "spherule.v1.ConeShape" as const, ...ends, fromRadius: 0.5, toRadius: 2, open: false };
  for (const [hollow, open] of [
    [false, false],
    [true, false],
    [false, true],
  ] as const) {
    const { vertices, oneSided } = drawn({ case: "cone", value: { ...value, hollow, open } });
    assert.equal(oneSided, hollow || open);
    const sign = oneSided ? -1 : 1;
    const slant = Math.hypot(5, 1.5);
    let onEnds = 0;
    for (const [out, along, across, up] of around(vertices, [1, 0, 0], axis)) {
      if (Math.abs(across * slant - sign * 5) < 1e-9) {
        near(out, 0.5 + 0.3 * along);
        near(up * slant, -sign * 1.5);
      } else {
        near(Math.abs(up), 1);
        onEnds += 1;
      }
    }
    assert.equal(onEnds > 0, !open);
  }
});

test("a capsule is drawn at its distance from the line", () => {
  const value = { $typeName: "spherule.v1.CapsuleShape" as const, ...ends, radius: 0.7, hollow: false };
  const { vertices } = drawn({ case: "capsule", value });
  for (const [out, along] of around(vertices, [1, 0, 0], axis)) {
    near(Math.hypot(out, along - Math.min(Math.max(along, 0), 5)), 0.7);
  }
});

test("a disc is drawn on both sides, with its hole", () => {
  const value = {
    $typeName: "spherule.v1.DiscShape" as const,
    centre: [1, 0, 0],
    normal: [0, 3, 4],
    radius: 2,
    hole: 0.5,
  };
  const { vertices, oneSided } = drawn({ case: "disc", value });
  assert.ok(!oneSided);
  const sides = around(vertices, [1, 0, 0], axis).map(([out, along, , up]) => {
    near(along, 0);
    assert.ok(out > 0.5 - 1e-9 && out < 2 + 1e-9);
    return Math.round(up);
  });
  assert.deepEqual([...new Set(sides)].sort(), [-1, 1]);
});

test("an obstacle is drawn where its rotation and translation put it, a plane still within the bounds", () => {
  const place = { rotation: { axis: [0, 0, 2], degrees: 90 }, translation: [1, 2, 3] };
  const box = { $typeName: "spherule.v1.Box" as const, min: [0, 0, 0], max: [1, 2, 3], hollow: false };
  const corners = drawn({ case: "box", value: box }, place).vertices.map(({ place: [x, y, z] }) => [x, y, z]);
  for (const k of [0, 1, 2]) {
    near(Math.min(...corners.map((corner) => corner[k] ?? NaN)), [-1, 2, 3][k] ?? NaN);
    near(Math.max(...corners.map((corner) => corner[k] ?? NaN)), [1, 3, 6][k] ?? NaN);
  }
  const plane = { $typeName: "spherule.v1.Plane" as const, point: [0, 0, 0], normal: [1, 0, 0] };
  for (const { place: at, normal } of drawn({ case: "plane", value: plane }, place).vertices) {
    near(dot(normal, [0, 1, 0]), 1);
    near(at[1], 2);
  }
  const slanted = { rotation: { axis: [1, 2, 3], degrees: 40 }, translation: [1, 1, 0] };
  for (const { place: at } of drawn({ case: "plane", value: plane }, slanted).vertices) {
    assert.ok(
      at.every((part) => Math.abs(part) <= 5 + 1e-9),
      `${at}`,
    );
  }
});

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
  const value = { $typeName: "spherule.v1.Box" as const, min: [0, 0, 0], max: [1, 2, 3], hollow: false };
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
  const cone = { $typeName: "spherule.v1.ConeShape" as const, ...ends, fromRadius: 0, toRadius: 2 };
  const capsule = { $typeName: "spherule.v1.CapsuleShape" as const, ...ends, radius: 0.7 };
  const disc = {
    $typeName: "spherule.v1.DiscShape" as const,
    centre: [1, 0, 0],
    normal: [0, 3, 4],
    radius: 2,
    hole: 0.5,
  };
  const shapes: Obstacle["shape"][] = [
    { case: "plane", value: plane },
    { case: "disc", value: disc },
    { case: "cone", value: { ...cone, hollow: false, open: true } },
    { case: "cylinder", value: { ...cylinder, hollow: false, open: true } },
  ];
  for (const hollow of [false, true]) {
    shapes.push(
      { case: "box", value: { ...box, hollow } },
      { case: "sphere", value: { ...sphere, hollow } },
      { case: "cylinder", value: { ...cylinder, hollow, open: false } },
      { case: "cone", value: { ...cone, hollow, open: false } },
      { case: "capsule", value: { ...capsule, hollow } },
    );
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

// A tetrahedron, turned by 90 degrees about z and moved.
for (const form of ["solid", "hollow", "sheet"]) {
  test(`a ${form} mesh is drawn with the triangles that the server sends`, () => {
    const mesh = { solid: form === "solid", hollow: form === "hollow" };
    const made = create(ObstacleSchema, {
      shape: { case: "mesh", value: mesh },
      rotation: { axis: [0, 0, 1], degrees: 90 },
      translation: [0, 0, 1],
    });
    const points = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
    const indices = new Uint32Array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    const triangles = create(MeshFactsSchema, {
      min: [0, 0, 0],
      max: [1, 1, 1],
      vertices: new Uint8Array(points.buffer),
      indices: new Uint8Array(indices.buffer),
    });
    const placement = placementOf(made);
    const draw = (facts: typeof triangles): ReturnType<typeof surfaceOf> =>
      surfaceOf({ shape: made.shape, placement, colour: undefined, triangles: facts }, grey, bounds);
    const { vertices, oneSided } = draw(triangles);
    assert.equal(oneSided, form === "hollow");
    assert.equal(vertices.length, (form === "sheet" ? 24 : 12) * vertexFloats);
    // The last triangle of a solid: (1, 0, 0), (0, 1, 0), (0, 0, 1), seen from outside.
    const last = form === "sheet" ? 18 : 9;
    const at = vertices.slice(last * vertexFloats, last * vertexFloats + 6);
    [0, 1, 1, -Math.SQRT1_2 * Math.sqrt(2 / 3), Math.sqrt(1 / 3), Math.sqrt(1 / 3)].forEach((value, k) => {
      assert.ok(Math.abs((at[k] ?? NaN) - value) < 1e-6, `${k}: ${at[k]} instead of ${value}`);
    });
    // Without triangles, its box is drawn.
    const box = draw(create(MeshFactsSchema, { min: [0, 0, 0], max: [1, 1, 1] }));
    assert.equal(box.vertices.length, 36 * vertexFloats);
  });
}
