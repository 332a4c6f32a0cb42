import * as mat4 from "gl-matrix/esm/mat4.js";
import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Vec3 } from "../model/facts";

/** A camera that looks at `target` from `distance` (m). Angles in radians; z is up. */
export interface Pose {
  target: Vec3;
  distance: number;
  azimuth: number; // of the eye around z, from +x towards +y
  elevation: number; // of the eye above the target's horizontal plane
}

const steepest = Math.PI / 2 - 0.01; // at 90 degrees the up direction is undefined

/** `into`: the point to change and return. */
export function eyeOf({ target, distance, azimuth, elevation }: Pose, into: Vec3 = [0, 0, 0]): Vec3 {
  const flat = distance * Math.cos(elevation);
  into[0] = target[0] + flat * Math.cos(azimuth);
  into[1] = target[1] + flat * Math.sin(azimuth);
  into[2] = target[2] + distance * Math.sin(elevation);
  return into;
}

export function poseFrom(eye: Vec3, target: Vec3): Pose {
  const [x, y, z] = [eye[0] - target[0], eye[1] - target[1], eye[2] - target[2]];
  const distance = Math.max(1e-6, Math.hypot(x, y, z));
  return {
    target: [...target],
    distance,
    azimuth: x === 0 && y === 0 ? -Math.PI / 2 : Math.atan2(y, x),
    elevation: clampElevation(Math.asin(Math.min(1, Math.max(-1, z / distance)))),
  };
}

export function orbited(pose: Pose, byAzimuth: number, byElevation: number): Pose {
  return {
    ...pose,
    azimuth: pose.azimuth + byAzimuth,
    elevation: clampElevation(pose.elevation + byElevation),
  };
}

/** Moves the target in the image plane, by metres to the right and up. */
export function panned(pose: Pose, right: number, up: number): Pose {
  const { azimuth, elevation } = pose;
  const [ca, sa, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
  return {
    ...pose,
    target: [
      pose.target[0] - right * sa - up * se * ca,
      pose.target[1] + right * ca - up * se * sa,
      pose.target[2] + up * ce,
    ],
  };
}

/**
 * Multiplies the distance by `factor`. The point that lies `right` and `up` metres off the target stays in its place on
 * the canvas.
 */
export function zoomed(pose: Pose, factor: number, right: number, up: number, limits: [number, number]): Pose {
  const distance = Math.min(limits[1], Math.max(limits[0], pose.distance * factor));
  const keep = 1 - distance / pose.distance;
  return { ...panned(pose, right * keep, up * keep), distance };
}

/** A pose that sees all of the box, from slightly above and beside it. */
export function framing(min: Vec3, max: Vec3, fieldOfView: number): Pose {
  const target: Vec3 = [(min[0] + max[0]) / 2, (min[1] + max[1]) / 2, (min[2] + max[2]) / 2];
  const radius = 0.5 * Math.hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
  const half = (fieldOfView * Math.PI) / 360;
  return { target, distance: Math.max(1e-3, (0.92 * radius) / Math.sin(half)), azimuth: -1.05, elevation: 0.38 };
}

/** Moves a pose towards another by `share` in 0..1. */
export function approached(from: Pose, to: Pose, share: number): Pose {
  const turn = Math.atan2(Math.sin(to.azimuth - from.azimuth), Math.cos(to.azimuth - from.azimuth));
  return {
    target: vec3.lerp([0, 0, 0], from.target, to.target, share) as Vec3,
    distance: from.distance * (to.distance / from.distance) ** share,
    azimuth: from.azimuth + share * turn,
    elevation: from.elevation + share * (to.elevation - from.elevation),
  };
}

export function near(a: Pose, b: Pose): boolean {
  const e = 1e-4;
  return (
    vec3.distance(a.target, b.target) < e * b.distance &&
    Math.abs(a.distance / b.distance - 1) < e &&
    Math.abs(Math.sin(a.azimuth - b.azimuth)) < e &&
    Math.abs(a.elevation - b.elevation) < e
  );
}

const centre: Vec3 = [0, 0, 0];
const upwards: Vec3 = [0, 0, 1];
const direction: Vec3 = [0, 0, 0];

/** The rotation from the axes of the scene to the ones of the view. `into`: the matrix to change and return. */
export function rotationOf({ azimuth, elevation }: Pose, into: mat4 = mat4.create()): mat4 {
  direction[0] = -Math.cos(elevation) * Math.cos(azimuth);
  direction[1] = -Math.cos(elevation) * Math.sin(azimuth);
  direction[2] = -Math.sin(elevation);
  return mat4.lookAt(into, centre, direction, upwards);
}

function clampElevation(elevation: number): number {
  return Math.min(steepest, Math.max(-steepest, elevation));
}
