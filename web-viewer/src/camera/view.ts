import * as mat4 from "gl-matrix/esm/mat4.js";
import { eyeOf, rotationOf } from "./orbit";
import type { Pose } from "./orbit";
import type { Vec3 } from "../model/facts";

/** Margins of the canvas that the page's elements cover, in CSS pixels. */
export interface Insets {
  top: number;
  right: number;
  bottom: number;
  left: number;
}

export interface View {
  eye: Vec3; // m
  projection: mat4;
  toClip: mat4; // from positions relative to the eye to clip space; it does not translate
  fromClip: mat4; // its inverse
  width: number; // CSS pixels
  height: number;
  halfTangent: number; // tangent of half the vertical angle of view
  near: number;
  far: number;
}

/**
 * Computes the matrices. The pose's target lies in the middle of the part of the canvas that is not covered. `reach`: m
 * around the target that are visible.
 */
export function viewOf(
  pose: Pose,
  fieldOfView: number,
  width: number,
  height: number,
  insets: Insets,
  reach: number,
): View {
  const free = {
    width: Math.max(1, width - insets.left - insets.right),
    height: Math.max(1, height - insets.top - insets.bottom),
  };
  // The field of view applies to the shorter side of the free part, so that an upright phone sees as much as a desktop.
  const scale = height / Math.min(free.height, free.width);
  const halfTangent = Math.tan((fieldOfView * Math.PI) / 360) * scale;
  const near = Math.max(pose.distance * 0.01, pose.distance - reach);
  const far = pose.distance + reach;
  const projection = mat4.perspective(mat4.create(), 2 * Math.atan(halfTangent), width / height, near, far);
  projection[8] -= (insets.left - insets.right) / width;
  projection[9] -= (insets.bottom - insets.top) / height;
  const toClip = mat4.multiply(mat4.create(), projection, rotationOf(pose));
  const fromClip = mat4.invert(mat4.create(), toClip) ?? mat4.create();
  return { eye: eyeOf(pose), projection, toClip, fromClip, width, height, halfTangent, near, far };
}
