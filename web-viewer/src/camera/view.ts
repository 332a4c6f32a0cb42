import * as mat4 from "gl-matrix/esm/mat4.js";
import * as vec3 from "gl-matrix/esm/vec3.js";
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
  halfTangent: number; // tangent of half the vertical angle of view, or of that in which the target's plane is seen
  near: number; // m along the direction of the view; negative: behind the eye
  far: number;
  forward: Vec3; // direction of the view, unit length
  orthographic: boolean; // all rays are parallel
  distance: number; // m, from the eye to the target
  part: Part; // of the whole picture
}

/** A rectangle of a picture, in shares of its width and height, from the lower left corner. */
export interface Part {
  x: number;
  y: number;
  width: number;
  height: number;
}

const whole: Part = { x: 0, y: 0, width: 1, height: 1 };

/**
 * The least extent of the picture in the free part of the canvas: tangents of the angles at the eye between the view's
 * axis and the edges of the picture.
 */
export interface Extent {
  horizontal: number;
  vertical: number;
  least: number; // in both directions: half the field of view
}

const widest = 16 / 9; // the aspect ratio for which scenes choose their cameras
const margin = 1.04;

/** The extent that shows the box from a pose. Parts of the box outside of the pose's own 16:9 picture do not count. */
export function extentOf(pose: Pose, fieldOfView: number, min: Vec3, max: Vec3): Extent {
  const least = Math.tan((fieldOfView * Math.PI) / 360);
  const eye = eyeOf(pose);
  rotationOf(pose, rotation);
  let [horizontal, vertical] = [0, 0];
  for (let corner = 0; corner < 8; corner++) {
    const point: Vec3 = [(corner & 1 ? max : min)[0], (corner & 2 ? max : min)[1], (corner & 4 ? max : min)[2]];
    const from = vec3.subtract([0, 0, 0], point, eye);
    const [x, y, z] = vec3.transformMat4([0, 0, 0], from, rotation) as Vec3;
    const depth = Math.max(1e-9, -z); // a corner behind the eye is outside of every picture
    horizontal = Math.max(horizontal, Math.abs(x) / depth);
    vertical = Math.max(vertical, Math.abs(y) / depth);
  }
  return {
    horizontal: Math.min(margin * horizontal, widest * least),
    vertical: Math.min(margin * vertical, least),
    least,
  };
}

/** The tangent per pixel with which a free part of this size (CSS pixels) shows the extent. */
export function tangentPerPixel({ horizontal, vertical, least }: Extent, width: number, height: number): number {
  // The field of view applies to the shorter side, so that an upright phone sees as much as a desktop.
  return 2 * Math.max(least / Math.min(width, height), horizontal / width, vertical / height);
}

const rotation = mat4.create(); // scratch: a view is computed for every image while the camera moves

/**
 * Computes the matrices. The pose's target lies in the middle of the part of the canvas that is not covered, and this
 * part shows the extent. `reach`: m around the target that are visible. `into`: the view to change and return.
 */
export function viewOf(
  pose: Pose,
  extent: Extent,
  width: number,
  height: number,
  insets: Insets,
  reach: number,
  orthographic = false,
  into: View = emptyView(),
): View {
  const freeWidth = Math.max(1, width - insets.left - insets.right);
  const freeHeight = Math.max(1, height - insets.top - insets.bottom);
  const halfTangent = 0.5 * height * tangentPerPixel(extent, freeWidth, freeHeight);
  const { distance } = pose;
  const near = orthographic ? distance - reach : Math.max(distance * 0.01, distance - reach);
  const far = distance + reach;
  const { projection, eye, forward } = into;
  const across = (insets.left - insets.right) / width;
  const up = (insets.bottom - insets.top) / height;
  if (orthographic) {
    const half = distance * halfTangent; // m
    const side = (half * width) / height;
    mat4.ortho(projection, -side, side, -half, half, near, far);
    projection[12] += across;
    projection[13] += up;
  } else {
    mat4.perspective(projection, 2 * Math.atan(halfTangent), width / height, near, far);
    projection[8] -= across;
    projection[9] -= up;
  }
  mat4.multiply(into.toClip, projection, rotationOf(pose, rotation));
  if (!mat4.invert(into.fromClip, into.toClip)) mat4.identity(into.fromClip);
  eyeOf(pose, eye);
  vec3.normalize(forward, vec3.subtract(forward, pose.target, eye));
  into.width = width;
  into.height = height;
  into.halfTangent = halfTangent;
  into.near = near;
  into.far = far;
  into.orthographic = orthographic;
  into.distance = distance;
  return into;
}

function emptyView(): View {
  return {
    eye: [0, 0, 0],
    projection: mat4.create(),
    toClip: mat4.create(),
    fromClip: mat4.create(),
    width: 1,
    height: 1,
    halfTangent: 1,
    near: 0,
    far: 1,
    forward: [0, 0, 0],
    orthographic: false,
    distance: 1,
    part: whole,
  };
}

/** The view of a part of a picture. */
export function viewOfPart(view: View, part: Part): View {
  const [x, y] = [2 * part.x + part.width - 1, 2 * part.y + part.height - 1]; // the middle in clip space
  const toPart = mat4.fromScaling(mat4.create(), [1 / part.width, 1 / part.height, 1]);
  mat4.translate(toPart, toPart, [-x, -y, 0]);
  const toClip = mat4.multiply(mat4.create(), toPart, view.toClip);
  return {
    ...view,
    projection: mat4.multiply(mat4.create(), toPart, view.projection),
    toClip,
    fromClip: mat4.invert(mat4.create(), toClip) ?? mat4.create(),
    width: view.width * part.width,
    height: view.height * part.height,
    halfTangent: view.halfTangent * part.height,
    part,
  };
}
