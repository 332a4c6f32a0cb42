import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Vec3 } from "../model/facts";

/** Vertices as a flat list: position (3), normal (3), colour (4). Three vertices make a triangle, or two a line. */
export type Vertices = number[];
export const vertexFloats = 10;

/** `normal` is of unit length. */
export interface Plane {
  point: Vec3;
  normal: Vec3;
}

/** The part of the plane that lies in the box, as a polygon around its normal; empty if they do not meet. */
export function planeInBox(plane: Plane, min: Vec3, max: Vec3): Vec3[] {
  const corner = (i: number): Vec3 => [(i & 1 ? max : min)[0], (i & 2 ? max : min)[1], (i & 4 ? max : min)[2]];
  const height = (p: Vec3): number => vec3.dot(plane.normal, vec3.subtract([0, 0, 0], p, plane.point));
  const points: Vec3[] = [];
  for (let i = 0; i < 8; i++) {
    for (const bit of [1, 2, 4]) {
      if (i & bit) continue;
      const [a, b] = [corner(i), corner(i | bit)];
      const [ha, hb] = [height(a), height(b)];
      if (ha === 0 && hb === 0) continue;
      if (ha * hb <= 0) points.push(vec3.lerp([0, 0, 0], a, b, ha / (ha - hb)) as Vec3);
    }
  }
  if (points.length < 3) return [];
  const sum = points.reduce((total, p) => vec3.add([0, 0, 0], total, p) as Vec3, [0, 0, 0]);
  const centre = vec3.scale([0, 0, 0], sum, 1 / points.length);
  const [u, v] = across(plane.normal);
  const angle = (p: Vec3): number => {
    const from = vec3.subtract([0, 0, 0], p, centre);
    return Math.atan2(vec3.dot(from, v), vec3.dot(from, u));
  };
  return points.sort((a, b) => angle(a) - angle(b));
}

export function polygon(points: Vec3[], normal: Vec3, colour: number[]): Vertices {
  const vertices: Vertices = [];
  for (let i = 2; i < points.length; i++) {
    for (const point of [points[0], points[i - 1], points[i]]) {
      vertices.push(...(point ?? [0, 0, 0]), ...normal, ...colour);
    }
  }
  return vertices;
}

/** The six faces of a box, with outward normals. */
export function faces(min: Vec3, max: Vec3): { normal: Vec3; points: Vec3[] }[] {
  return [0, 1, 2].flatMap((axis) =>
    [-1, 1].map((side) => {
      const normal: Vec3 = [0, 0, 0];
      normal[axis] = side;
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      const points = [0, 1, 3, 2].map((i) => {
        const point: Vec3 = [0, 0, 0];
        point[axis] = (side > 0 ? max : min)[axis] ?? 0;
        point[u] = ((i & 1) > 0 ? max : min)[u] ?? 0;
        point[v] = ((i & 2) > 0 ? max : min)[v] ?? 0;
        return point;
      });
      return { normal, points: side > 0 ? points : points.reverse() };
    }),
  );
}

/** Two unit vectors across the normal, and across each other. */
export function across(normal: Vec3): [Vec3, Vec3] {
  const other: Vec3 = Math.abs(normal[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  const u = vec3.normalize([0, 0, 0], vec3.cross([0, 0, 0], other, normal)) as Vec3;
  return [u, vec3.cross([0, 0, 0], normal, u) as Vec3];
}
