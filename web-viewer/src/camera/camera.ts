import type { Facts } from "../model/facts";
import { approached, framing, near, orbited, panned, poseFrom, zoomed } from "./orbit";
import type { Pose } from "./orbit";
import { viewOf } from "./view";
import type { Insets, View } from "./view";

const orbitSpeed = 0.006; // radians per pixel
const ease = 70; // ms, time constant with which the pose approaches the goal

/** A camera whose movements set a goal pose, which the shown pose approaches smoothly. */
export class Camera {
  pose: Pose = { target: [0, 0, 0], distance: 5, azimuth: -1, elevation: 0.4 };
  insets: Insets = { top: 0, right: 0, bottom: 0, left: 0 };
  private goal: Pose = this.pose;
  private home: Pose = this.pose;
  private fieldOfView = 45;
  private extent = 10; // m, diagonal of the bounds
  private size: [number, number] = [1, 1];
  private current: View = viewOf(this.pose, 45, 1, 1, this.insets, 10);

  /** Takes the scene's camera, or one that sees all of its bounds. `stay`: keeps the present pose. */
  look(facts: Facts, stay: boolean): void {
    this.fieldOfView = facts.fieldOfView;
    this.extent = Math.hypot(facts.max[0] - facts.min[0], facts.max[1] - facts.min[1], facts.max[2] - facts.min[2]);
    const { eye, target } = facts;
    this.home = eye && target ? poseFrom(eye, target) : framing(facts.min, facts.max, facts.fieldOfView);
    if (!stay) this.pose = this.goal = this.home;
  }

  reset(): void {
    this.goal = this.home;
  }

  /** Looks in a direction (radians), from the present distance. */
  along(azimuth: number, elevation: number): void {
    this.goal = { ...this.home, distance: this.goal.distance, azimuth, elevation };
  }

  resize(width: number, height: number): void {
    this.size = [Math.max(1, width), Math.max(1, height)];
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
    this.goal = zoomed(this.goal, factor, dx * metres, -dy * metres, [0.01 * this.extent, 8 * this.extent]);
  }

  /** Moves the pose by `elapsed` ms. `still`: to the goal at once. Returns false if it has reached its goal. */
  advance(elapsed: number, still = false): boolean {
    if (this.pose === this.goal) return false;
    const share = still ? 1 : 1 - Math.exp(-elapsed / ease);
    this.pose = near(this.pose, this.goal) ? this.goal : approached(this.pose, this.goal, share);
    return true;
  }

  view(): View {
    const reach = 3 * this.extent + Math.hypot(...this.pose.target.map((t, i) => t - (this.home.target[i] ?? 0)));
    this.current = viewOf(this.pose, this.fieldOfView, this.size[0], this.size[1], this.insets, reach);
    return this.current;
  }

  /** The view of the last image. */
  get last(): View {
    return this.current;
  }

  private metresPerPixel(): number {
    return (2 * this.goal.distance * this.current.halfTangent) / this.size[1];
  }
}
