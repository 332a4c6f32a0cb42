import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Facts, Vec3 } from "../model/facts";
import { freePart } from "./free_part";
import type { Box } from "./free_part";
import { approached, framing, near, orbited, panned, poseFrom, zoomed } from "./orbit";
import type { Pose } from "./orbit";
import { extentOf, tangentPerPixel, viewOf } from "./view";
import type { Extent, Insets, View } from "./view";

const orbitSpeed = 0.006; // radians per pixel
const sides = ["top", "right", "bottom", "left"] as const;
const ease = 70; // ms, time constant with which the pose approaches the goal

interface Shown {
  pose: Pose;
  insets: Insets;
  extent: Extent;
  size: [number, number];
  orthographic: boolean;
}

/** A camera whose movements set a goal pose, which the shown pose approaches smoothly. */
export class Camera {
  pose: Pose = { target: [0, 0, 0], distance: 5, azimuth: -1, elevation: 0.4 };
  orthographic = false;
  private goal: Pose = this.pose;
  private home: Pose = this.pose;
  private extent: Extent = { horizontal: 0, vertical: 0, least: 0.4 }; // of the scene, in the home pose
  private diagonal = 10; // m, of the bounds
  private size: [number, number] = [1, 1];
  private covered: readonly Box[] = [];
  private insets: Insets = { top: 0, right: 0, bottom: 0, left: 0 };
  private insetsGoal: Insets = this.insets;
  private jumps = true; // the next insets are taken at once
  private tracked: Vec3 | undefined;
  private shown: Shown | undefined; // the origin of `current`
  private readonly current: View = viewOf(this.pose, this.extent, 1, 1, this.insets, 10);

  /** Takes the scene's camera, or one that sees all of its bounds. `stay`: keeps the present pose. */
  look(facts: Facts, stay: boolean): void {
    this.diagonal = Math.hypot(facts.max[0] - facts.min[0], facts.max[1] - facts.min[1], facts.max[2] - facts.min[2]);
    const { eye, target } = facts;
    this.home = eye && target ? poseFrom(eye, target) : framing(facts.min, facts.max, facts.fieldOfView);
    this.extent = extentOf(this.home, facts.fieldOfView, facts.min, facts.max);
    if (!stay) this.pose = this.goal = this.home;
    this.findFreePart(!stay);
  }

  /** `boxes`: what covers the canvas. The picture moves to the part in which it is largest. */
  cover(boxes: readonly Box[]): void {
    if (boxes === this.covered) return;
    this.covered = boxes;
    this.findFreePart(false);
  }

  reset(): void {
    this.goal = this.home;
  }

  /** Looks from one point at another (m). */
  place(eye: Vec3, target: Vec3): void {
    this.pose = this.goal = poseFrom(eye, target);
  }

  /** Looks in a direction (radians), from the present distance. */
  along(azimuth: number, elevation: number): void {
    const target = this.tracked ? this.goal.target : this.home.target;
    this.goal = { target, distance: this.goal.distance, azimuth, elevation };
  }

  /**
   * Keeps a moving point (m) at its place in the image; undefined: no longer. The first point comes to the middle. Call
   * it before each image.
   */
  track(point: Vec3 | undefined): void {
    const before = this.tracked;
    this.tracked = point;
    if (!point) return;
    if (!before) this.goal = { ...this.goal, target: [...point] };
    else if (vec3.exactEquals(before, point)) this.tracked = before;
    else {
      const by = vec3.subtract([0, 0, 0], point, before) as Vec3;
      const isThere = this.pose === this.goal;
      this.goal = moved(this.goal, by);
      this.pose = isThere ? this.goal : moved(this.pose, by);
    }
  }

  resize(width: number, height: number): void {
    this.size = [Math.max(1, width), Math.max(1, height)];
    this.findFreePart(true);
  }

  orbit(dx: number, dy: number): void {
    this.goal = orbited(this.goal, -dx * orbitSpeed, dy * orbitSpeed);
  }

  pan(dx: number, dy: number): void {
    const metres = this.metresPerPixel();
    this.goal = panned(this.goal, -dx * metres, dy * metres);
  }

  /** Zooms towards a point of the canvas (CSS pixels); towards the target if there is none. */
  zoom(factor: number, x?: number, y?: number): void {
    const metres = this.metresPerPixel();
    const { top, right, bottom, left } = this.insets;
    const dx = x === undefined ? 0 : x - (this.size[0] + left - right) / 2;
    const dy = y === undefined ? 0 : y - (this.size[1] + top - bottom) / 2;
    this.goal = zoomed(this.goal, factor, dx * metres, -dy * metres, [0.01 * this.diagonal, 8 * this.diagonal]);
  }

  /** Moves pose and insets by `elapsed` ms. `still`: to their goals at once. */
  advance(elapsed: number, still = false): void {
    const share = still ? 1 : 1 - Math.exp(-elapsed / ease);
    if (this.jumps) this.insets = this.insetsGoal;
    else if (this.insets !== this.insetsGoal) this.insets = between(this.insets, this.insetsGoal, share);
    this.jumps = false;
    if (this.pose !== this.goal) {
      this.pose = near(this.pose, this.goal) ? this.goal : approached(this.pose, this.goal, share);
    }
  }

  /** The present view: one object, which the next call changes. */
  view(): View {
    const { pose, insets, extent, size, orthographic, shown } = this;
    const isShown = shown?.pose === pose && shown.insets === insets && shown.extent === extent && shown.size === size;
    if (isShown && shown.orthographic === orthographic) return this.current;
    this.shown = { pose, insets, extent, size, orthographic };
    const [width, height] = size;
    viewOf(pose, extent, width, height, insets, this.reach, orthographic, this.current);
    return this.current;
  }

  /** The view of a picture of another shape, which shows at least as much of the scene. Sizes in CSS pixels. */
  viewFor(width: number, height: number): View {
    const { pose, extent, orthographic, reach } = this;
    return viewOf(pose, extent, width, height, { top: 0, right: 0, bottom: 0, left: 0 }, reach, orthographic);
  }

  /** The view of the last image. */
  get last(): View {
    return this.current;
  }

  /** m around the target that are visible. */
  private get reach(): number {
    return 3 * this.diagonal + vec3.distance(this.pose.target, this.home.target);
  }

  /** `jumps`: the picture goes there at once. */
  private findFreePart(jumps: boolean): void {
    const [width, height] = this.size;
    this.insetsGoal = freePart(width, height, this.covered, (w, h) => 1 / tangentPerPixel(this.extent, w, h));
    this.jumps ||= jumps;
  }

  private metresPerPixel(): number {
    return (2 * this.goal.distance * this.current.halfTangent) / this.size[1];
  }
}

function moved(pose: Pose, by: Vec3): Pose {
  return { ...pose, target: vec3.add([0, 0, 0], pose.target, by) as Vec3 };
}

/** Insets on the way from one to another, by `share` in 0..1. The last half pixel is one step, to `to` itself. */
function between(from: Insets, to: Insets, share: number): Insets {
  if (sides.every((side) => Math.abs(to[side] - from[side]) < 0.5)) return to;
  const part = (side: keyof Insets): number =>
    Math.abs(to[side] - from[side]) < 0.5 ? to[side] : from[side] + share * (to[side] - from[side]);
  return { top: part("top"), right: part("right"), bottom: part("bottom"), left: part("left") };
}
