import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Obstacle } from "../gen/spherule/v1/obstacle_pb";

/** How an obstacle lies in the scene: its shape is turned about the origin of its coordinates, then moved. */
export interface Placement {
  turn: [number, number, number, number]; // a quaternion of unit length
  move: [number, number, number]; // m
}

type Vec3 = Placement["move"];

/** Undefined: the obstacle is where its shape says. */
export function placementOf({ rotation, translation: [x = 0, y = 0, z = 0] }: Obstacle): Placement | undefined {
  if (!rotation && !x && !y && !z) return undefined;
  const half = ((rotation?.degrees ?? 0) * Math.PI) / 360;
  const axis = vec3.normalize([0, 0, 0], rotation?.axis ?? [0, 0, 1]);
  const [a, b, c] = vec3.scale([0, 0, 0], axis, Math.sin(half)) as Vec3;
  return { turn: [a, b, c, Math.cos(half)], move: [x, y, z] };
}

/** The direction in the scene that a direction of the shape has. */
export function turned(placement: Placement | undefined, direction: Vec3): Vec3 {
  return placement ? (vec3.transformQuat([0, 0, 0], direction, placement.turn) as Vec3) : direction;
}

/** The place in the scene of a point of the shape (m). */
export function placed(placement: Placement | undefined, point: Vec3): Vec3 {
  return placement ? (vec3.add([0, 0, 0], turned(placement, point), placement.move) as Vec3) : point;
}

/** The point of the shape's coordinates at a place in the scene (m). */
export function unplaced(placement: Placement | undefined, place: Vec3): Vec3 {
  if (!placement) return place;
  const [x, y, z, w] = placement.turn;
  return vec3.transformQuat([0, 0, 0], vec3.subtract([0, 0, 0], place, placement.move), [-x, -y, -z, w]) as Vec3;
}
