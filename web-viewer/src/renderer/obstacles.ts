import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Obstacle, Vec3 } from "../model/facts";
import { placed, turned } from "../model/placement";
import type { Placement } from "../model/placement";
import { across, faces, planeInBox, polygon, vertexFloats } from "./shapes";
import type { Vertices } from "./shapes";

/** How an obstacle looks: triangles whose normals point out of the solid. */
export interface Surface {
  vertices: Vertices;
  /** The free space is in front of it alone: a viewer behind it must see through it. */
  oneSided: boolean;
}

type Shape = Obstacle["shape"];
type Bounds = { min: Vec3; max: Vec3 };
type Draw<Case> = (shape: Extract<Shape, { case: Case }>["value"], colour: number[]) => Surface;

/** One function for each shape of obstacle.proto that has an end. */
const surfaces: { [Case in Exclude<NonNullable<Shape["case"]>, "plane" | "mesh" | "heightField">]: Draw<Case> } = {
  box: ({ min, max, hollow }, colour) => {
    const sides = faces(min as Vec3, max as Vec3);
    const inward = (normal: Vec3): Vec3 => [-normal[0], -normal[1], -normal[2]];
    const vertices = sides.flatMap(({ normal, points }) =>
      hollow ? polygon(points.reverse(), inward(normal), colour) : polygon(points, normal, colour),
    );
    return { vertices, oneSided: hollow };
  },
  sphere: ({ centre, radius, hollow }, colour) => {
    const place = (direction: Vec3): Vec3 => vec3.scaleAndAdd([0, 0, 0], centre, direction, radius) as Vec3;
    return { vertices: round(meridian(), [0, 0, 1], place, hollow, colour), oneSided: hollow };
  },
  cylinder: ({ from, to, radius, hollow, open }, colour) =>
    cone(from as Vec3, to as Vec3, [radius, radius], hollow, open, colour),
  cone: ({ from, to, fromRadius, toRadius, hollow, open }, colour) =>
    cone(from as Vec3, to as Vec3, [fromRadius, toRadius], hollow, open, colour),
  capsule: ({ from, to, radius, hollow }, colour) => {
    const length = vec3.distance(from, to);
    const outline = meridian().map(({ across: out, along, normal }) => ({
      across: radius * out,
      along: radius * along + (along > 0 ? length : 0),
      normal,
    }));
    return turnedAround(from as Vec3, to as Vec3, outline, hollow, colour);
  },
  // Both sides are seen.
  disc: ({ centre, normal, radius, hole }, colour) => {
    const vertices = [1, -1].flatMap((side) => {
      const outline: Outline = [hole, radius].map((out) => ({ across: out, along: 0, normal: [0, -1] }));
      const axis = vec3.scale([0, 0, 0], vec3.normalize([0, 0, 0], normal), side) as Vec3;
      return round(outline, axis, (way) => vec3.add([0, 0, 0], centre, way) as Vec3, false, colour);
    });
    return { vertices, oneSided: false };
  },
};

/** A cone or a cylinder. An open one is seen as a hollow one without ends: one looks into it from outside. */
function cone(
  from: Vec3,
  to: Vec3,
  [low, high]: [number, number],
  hollow: boolean,
  open: boolean,
  colour: number[],
): Surface {
  const length = vec3.distance(from, to);
  const slant = Math.hypot(high - low, length);
  const normal: [number, number] = [length / slant, (low - high) / slant];
  const side: Outline = [
    { across: low, along: 0, normal },
    { across: high, along: length, normal },
  ];
  const outline: Outline = [
    { across: 0, along: 0, normal: [0, -1] },
    { across: low, along: 0, normal: [0, -1] },
    ...side,
    { across: high, along: length, normal: [0, 1] },
    { across: 0, along: length, normal: [0, 1] },
  ];
  return turnedAround(from, to, open ? side : outline, hollow || open, colour);
}

/** An outline, whose places along the axis are counted from `from`, turned around the axis to `to`. */
function turnedAround(from: Vec3, to: Vec3, outline: Outline, hollow: boolean, colour: number[]): Surface {
  const axis = vec3.normalize([0, 0, 0], vec3.subtract([0, 0, 0], to, from)) as Vec3;
  const place = (way: Vec3): Vec3 => vec3.add([0, 0, 0], from, way) as Vec3;
  return { vertices: round(outline, axis, place, hollow, colour), oneSided: hollow };
}

/** Returns the surface of an obstacle in the colour (RGBA); an empty one if its shape is unknown to this page. */
export function surfaceOf(obstacle: Obstacle, colour: number[], bounds: Bounds): Surface {
  const { shape, placement } = obstacle;
  if (shape.case === undefined) return { vertices: [], oneSided: false };
  if (shape.case === "plane") {
    const { point, normal } = shape.value;
    return planeIn(bounds, placed(placement, point as Vec3), turned(placement, normal as Vec3), colour);
  }
  if (shape.case === "mesh" || shape.case === "heightField") return meshSurface(obstacle, colour);
  const draw = surfaces[shape.case] as (shape: unknown, colour: number[]) => Surface;
  const surface = draw(shape.value, colour);
  if (placement) place(surface.vertices, placement);
  return surface;
}

/** The triangles of a mesh; its box if it has too many of them for the server to send. */
function meshSurface({ shape, placement, triangles }: Obstacle, colour: number[]): Surface {
  const mesh = shape.case === "mesh" ? shape.value : undefined;
  const sheet = !mesh?.solid && !mesh?.hollow;
  if (!triangles) return { vertices: [], oneSided: false };
  if (triangles.indices.length === 0) {
    const vertices = faces(triangles.min as Vec3, triangles.max as Vec3).flatMap(({ normal, points }) =>
      polygon(
        points.map((point) => placed(placement, point)),
        turned(placement, normal),
        colour,
      ),
    );
    return { vertices, oneSided: false };
  }
  const numbers = new Float32Array(triangles.vertices.slice().buffer);
  const points = Array.from({ length: numbers.length / 3 }, (_, k) =>
    placed(placement, [...numbers.subarray(3 * k, 3 * k + 3)] as Vec3),
  );
  const indices = new Uint32Array(triangles.indices.slice().buffer);
  const vertices: Vertices = [];
  for (let k = 0; k < indices.length; k += 3) {
    const [a, b, c] = [...indices.subarray(k, k + 3)].map((index) => points[index] ?? [0, 0, 0]) as [Vec3, Vec3, Vec3];
    const normal = vec3.cross([0, 0, 0], vec3.subtract([0, 0, 0], b, a), vec3.subtract([0, 0, 0], c, a)) as Vec3;
    vec3.normalize(normal, normal);
    vertices.push(...a, ...normal, ...colour, ...b, ...normal, ...colour, ...c, ...normal, ...colour);
    if (!sheet) continue;
    vec3.scale(normal, normal, -1);
    vertices.push(...a, ...normal, ...colour, ...c, ...normal, ...colour, ...b, ...normal, ...colour);
  }
  return { vertices, oneSided: mesh?.hollow ?? false };
}

/** The part of a plane that lies in the bounds. */
function planeIn({ min, max }: Bounds, point: Vec3, normal: Vec3, colour: number[]): Surface {
  const unit = vec3.normalize([0, 0, 0], normal) as Vec3;
  return { vertices: polygon(planeInBox({ point, normal: unit }, min, max), unit, colour), oneSided: true };
}

/** Moves vertices to where the obstacle lies. */
function place(vertices: Vertices, placement: Placement): void {
  for (let i = 0; i < vertices.length; i += vertexFloats) {
    const at = (k: number): Vec3 => vertices.slice(i + k, i + k + 3) as Vec3;
    vertices.splice(i, 6, ...placed(placement, at(0)), ...turned(placement, at(3)));
  }
}

/** A line that is turned around an axis. normal: its parts across and along the axis. */
type Outline = { across: number; along: number; normal: [number, number] }[];

const rounds = 64; // sides of a circle

/** A half circle of radius 1 around the centre. */
function meridian(): Outline {
  return Array.from({ length: rounds / 2 + 1 }, (_, i) => {
    const angle = (Math.PI * i) / (rounds / 2);
    const normal: [number, number] = [Math.sin(angle), -Math.cos(angle)];
    return { across: normal[0], along: normal[1], normal };
  });
}

/** The surface of an outline turned around the axis. `place`: where a point of it is in the scene. */
function round(outline: Outline, axis: Vec3, place: (way: Vec3) => Vec3, hollow: boolean, colour: number[]): Vertices {
  const [u, v] = across(axis);
  const sign = hollow ? -1 : 1;
  const vertex = (row: number, side: number): number[] => {
    const { across: out, along, normal } = outline[row] ?? { across: 0, along: 0, normal: [0, 0] };
    const angle = (2 * Math.PI * side) / rounds;
    const way = (from: number, up: number): Vec3 =>
      [0, 1, 2].map(
        (i) => from * (Math.cos(angle) * (u[i] ?? 0) + Math.sin(angle) * (v[i] ?? 0)) + up * (axis[i] ?? 0),
      ) as Vec3;
    return [...place(way(out, along)), ...way(sign * normal[0], sign * normal[1]), ...colour];
  };
  const vertices: Vertices = [];
  for (let row = 0; row + 1 < outline.length; row++) {
    for (let side = 0; side < rounds; side++) {
      const corners = [vertex(row, side), vertex(row, side + 1), vertex(row + 1, side + 1), vertex(row + 1, side)];
      const winding = hollow ? [0, 2, 1, 0, 3, 2] : [0, 1, 2, 0, 2, 3]; // counter-clockwise from the free side
      for (const i of winding) vertices.push(...(corners[i] ?? []));
    }
  }
  return vertices;
}
