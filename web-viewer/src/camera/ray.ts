import * as vec3 from "gl-matrix/esm/vec3.js";
import * as vec4 from "gl-matrix/esm/vec4.js";
import type { Vec3 } from "../model/facts";
import type { View } from "./view";

export interface Ray {
  origin: Vec3; // m
  direction: Vec3; // unit length
}

/** The ray through a point of the canvas (CSS pixels from its upper left corner): from the eye, or the near plane. */
export function rayThrough(view: View, x: number, y: number): Ray {
  const clip = vec4.fromValues((2 * x) / view.width - 1, 1 - (2 * y) / view.height, 0, 1);
  vec4.transformMat4(clip, clip, view.fromClip);
  const to: Vec3 = [clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]];
  const { eye, forward } = view;
  if (!view.orthographic) return { origin: eye, direction: vec3.normalize([0, 0, 0], to) as Vec3 };
  const start = vec3.add([0, 0, 0], eye, to);
  const back = view.near - vec3.dot(to, forward);
  return { origin: vec3.scaleAndAdd([0, 0, 0], start, forward, back) as Vec3, direction: forward };
}

/** Projects a point (m) to the canvas (CSS pixels); undefined if it lies behind the eye of a perspective view. */
export function project(view: View, point: Vec3): [number, number] | undefined {
  const [x, y, z] = vec3.subtract([0, 0, 0], point, view.eye) as Vec3;
  const clip = vec4.transformMat4(vec4.create(), [x, y, z, 1], view.toClip);
  if (clip[3] <= 0) return undefined;
  return [(0.5 + (0.5 * clip[0]) / clip[3]) * view.width, (0.5 - (0.5 * clip[1]) / clip[3]) * view.height];
}
