import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Ray } from "../camera/ray";
import type { View } from "../camera/view";
import type { Vec3 } from "../model/facts";

/** The axes of the picture in the world: to the right, upwards, and away from the eye. The camera stands upright. */
export function axesOf({ forward: away }: View): { right: Vec3; up: Vec3; away: Vec3 } {
  const flat = Math.hypot(away[0], away[1]);
  const right: Vec3 = [away[1] / flat, -away[0] / flat, 0];
  return { right, up: vec3.cross([0, 0, 0], right, away) as Vec3, away };
}

/** Where the ray meets the plane parallel to the picture through a point (m); undefined behind the eye. */
export function acrossPlane({ forward }: View, { origin, direction }: Ray, through: Vec3): Vec3 | undefined {
  const distance = vec3.dot(vec3.subtract([0, 0, 0], through, origin), forward) / vec3.dot(direction, forward);
  return distance > 0 ? (vec3.scaleAndAdd([0, 0, 0], origin, direction, distance) as Vec3) : undefined;
}

/** The point, moved by `by` (m) along the axes of the picture. */
export function moved(view: View, point: Vec3, by: Vec3): Vec3 {
  const { right, up, away } = axesOf(view);
  return point.map((at, k) => at + by[0] * (right[k] ?? 0) + by[1] * (up[k] ?? 0) + by[2] * (away[k] ?? 0)) as Vec3;
}
