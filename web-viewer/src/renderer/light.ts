import * as mat4 from "gl-matrix/esm/mat4.js";
import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Facts, Vec3 } from "../model/facts";
import type { Theme } from "./theme";

export interface Light {
  direction: Vec3; // to the light, unit length
  key: number[]; // linear light, of this direction
  sky: number[]; // linear light, from above
  ground: number[]; // linear light, from below
  right: Vec3; // across the shadow map
  up: Vec3;
  // Positions are relative to the centre of the bounds.
  clip: mat4; // position to the shadow map's clip space
  map: mat4; // position to the shadow map, 0..1
}

const height = 0.95; // radians above the horizon
const aside = 0.85; // radians to the left of the scene's camera

/**
 * The light that the scene asks for, with a shadow map that covers the bounds. By default it comes from the left of the
 * scene's camera, with the strengths and colours of the theme.
 */
export function lightFor(facts: Facts, theme: Theme): Light {
  const { light } = facts;
  const direction = vec3.normalize([0, 0, 0], light?.direction ?? usualDirection(facts)) as Vec3;
  const upright: Vec3 = Math.abs(direction[2]) < 0.999 ? [0, 0, 1] : [0, 1, 0];
  const right = vec3.normalize([0, 0, 0], vec3.cross([0, 0, 0], upright, direction)) as Vec3;
  const up = vec3.cross([0, 0, 0], direction, right) as Vec3;
  const half = [0, 0, 0];
  for (const corner of corners(facts)) {
    const from = vec3.subtract([0, 0, 0], corner, facts.origin);
    [right, up, direction].forEach((axis, i) => {
      half[i] = Math.max(half[i] ?? 0, Math.abs(vec3.dot(from, axis)));
    });
  }
  const [x = 1, y = 1, z = 1] = half.map((value) => value * 1.03 + 1e-3);
  const view = mat4.lookAt(mat4.create(), direction, [0, 0, 0], up);
  const clip = mat4.multiply(mat4.create(), mat4.ortho(mat4.create(), -x, x, -y, y, 1 - z, 1 + z), view);
  const map = mat4.fromTranslation(mat4.create(), [0.5, 0.5, 0.5]);
  mat4.scale(map, map, [0.5, 0.5, 0.5]);
  mat4.multiply(map, map, clip);
  const strength = light?.strength ?? 1;
  const white = Math.max(...theme.key);
  const key = (light?.colour ? light.colour.map((part) => part * part * white) : theme.key).map((x) => x * strength);
  const [sky, ground] = [theme.sky, theme.ground].map((colour) => colour.map((part) => part * (light?.sky ?? 1)));
  return { direction, key, sky: sky ?? [], ground: ground ?? [], right, up, clip, map };
}

function usualDirection(facts: Facts): Vec3 {
  const azimuth = cameraAzimuth(facts) - aside;
  const across = Math.cos(height);
  return [Math.cos(azimuth) * across, Math.sin(azimuth) * across, Math.sin(height)];
}

function cameraAzimuth(facts: Facts): number {
  const { eye, target } = facts;
  if (!eye || !target) return -1.05;
  return Math.atan2(eye[1] - target[1], eye[0] - target[0]);
}

function corners(facts: Facts): Vec3[] {
  const { min, max } = facts;
  return Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? max : min)[axis]) as Vec3);
}
