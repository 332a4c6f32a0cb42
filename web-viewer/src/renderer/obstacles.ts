import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Obstacle, Vec3 } from "../model/facts";
import { across, faces, planeInBox, polygon } from "./shapes";
import type { Vertices } from "./shapes";

/** How an obstacle looks: triangles whose normals point out of the solid. */
export interface Surface {
  vertices: Vertices;
  /** The free space is in front of it alone: a viewer behind it must see through it. */
  oneSided: boolean;
}

type Shape = Obstacle["shape"];
type Bounds = { min: Vec3; max: Vec3 };
type Draw<Case> = (shape: Extract<Shape, { case: Case }>["value"], colour: number[], bounds: Bounds) => Surface;

/** One function for each shape of scene.proto. */
const surfaces: { [Case in NonNullable<Shape["case"]>]: Draw<Case> } = {
  plane: ({ point, normal }, colour, { min, max }) => {
    const unit = vec3.normalize([0, 0, 0], normal) as Vec3;
    const points = planeInBox({ point: point as Vec3, normal: unit }, min, max);
    return { vertices: polygon(points, unit, colour), oneSided: true };
  },
  box: ({ min, max }, colour) => {
    const sides = faces(min as Vec3, max as Vec3);
    return { vertices: sides.flatMap(({ normal, points }) => polygon(points, normal, colour)), oneSided: false };
  },
  sphere: ({ centre, radius, hollow }, colour) => {
    const place = (direction: Vec3): Vec3 => vec3.scaleAndAdd([0, 0, 0], centre, direction, radius) as Vec3;
    return { vertices: round(meridian(), [0, 0, 1], place, hollow, colour), oneSided: hollow };
  },
  cylinder: ({ from, to, radius, hollow }, colour) => {
    const axis = vec3.subtract([0, 0, 0], to, from) as Vec3;
    const unit = vec3.normalize([0, 0, 0], axis) as Vec3;
    const outline: Outline = [
      { across: 0, along: 0, normal: [0, -1] },
      { across: radius, along: 0, normal: [0, -1] },
      { across: radius, along: 0, normal: [1, 0] },
      { across: radius, along: vec3.length(axis), normal: [1, 0] },
      { across: radius, along: vec3.length(axis), normal: [0, 1] },
      { across: 0, along: vec3.length(axis), normal: [0, 1] },
    ];
    const place = (way: Vec3): Vec3 => vec3.add([0, 0, 0], from, way) as Vec3;
    return { vertices: round(outline, unit, place, hollow, colour), oneSided: hollow };
  },
};

/** Returns the surface of an obstacle in the colour (RGBA); an empty one if its shape is unknown to this page. */
export function surfaceOf({ shape }: Obstacle, colour: number[], bounds: Bounds): Surface {
  if (shape.case === undefined) return { vertices: [], oneSided: false };
  const draw = surfaces[shape.case] as (shape: unknown, colour: number[], bounds: Bounds) => Surface;
  return draw(shape.value, colour, bounds);
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
