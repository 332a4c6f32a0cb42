import * as vec3 from "gl-matrix/esm/vec3.js";
import * as vec4 from "gl-matrix/esm/vec4.js";
import { shownImages } from "../model/positions";
import type { Facts, Vec3 } from "../model/facts";
import type { Shown } from "../model/states";
import type { View } from "./view";

export interface Ray {
  origin: Vec3; // m
  direction: Vec3; // unit length
}

/** The ray from the eye through a point of the canvas, in CSS pixels from its upper left corner. */
export function rayThrough(view: View, x: number, y: number): Ray {
  const clip = vec4.fromValues((2 * x) / view.width - 1, 1 - (2 * y) / view.height, 1, 1);
  vec4.transformMat4(clip, clip, view.fromClip);
  const direction = vec3.normalize([0, 0, 0], [clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]]) as Vec3;
  return { origin: view.eye, direction };
}

/** Projects a point (m) to the canvas (CSS pixels); undefined if it lies behind the eye. */
export function project(view: View, point: Vec3): [number, number] | undefined {
  const [x, y, z] = vec3.subtract([0, 0, 0], point, view.eye) as Vec3;
  const clip = vec4.transformMat4(vec4.create(), [x, y, z, 1], view.toClip);
  if (clip[3] <= 0) return undefined;
  return [(0.5 + (0.5 * clip[0]) / clip[3]) * view.width, (0.5 - (0.5 * clip[1]) / clip[3]) * view.height];
}

/** The distance along the ray at which it meets the surface of the sphere, from inside too; Infinity if it misses. */
export function hit(ray: Ray, centre: Vec3, radius: number): number {
  const to = vec3.subtract([0, 0, 0], centre, ray.origin);
  const along = vec3.dot(to, ray.direction);
  const half = radius * radius - (vec3.squaredLength(to) - along * along);
  if (vec3.squaredLength(to) < radius * radius) return along + Math.sqrt(half);
  if (half < 0 || along < 0) return Infinity;
  return along - Math.sqrt(half);
}

/** The place of the first sphere that the ray meets, in the positions that are drawn. */
export function pick(facts: Facts, shown: Shown, ray: Ray): number | undefined {
  let nearest = Infinity;
  let found: number | undefined;
  const count = Math.min(shown.from.count, shown.to.count);
  for (let place = 0; place < count; place++) {
    if (!facts.population.isUsed(place)) continue;
    for (const centre of shownImages(facts, shown, place)) {
      const distance = hit(ray, centre, facts.population.radiusOf(place));
      if (distance >= nearest) continue;
      nearest = distance;
      found = place;
    }
  }
  return found;
}
