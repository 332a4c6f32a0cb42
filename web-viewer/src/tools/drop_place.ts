import type { Ray } from "../camera/ray";
import type { Drop } from "../connection/commands";
import type { Facts, Obstacle, Vec3 } from "../model/facts";
import { unplaced } from "../model/placement";
import type { Placement } from "../model/placement";
import { writePose } from "../model/poses";
import type { State } from "../model/states";

type Bounds = Pick<Facts, "min" | "max">;

const mostSteps = 200; // on a ray
const fill = 0.15; // of the region, by spheres: random places without overlaps are then soon found
const margin = 1.1; // radii between dropped spheres and the bounds, or the place

const along = ({ origin, direction }: Ray, distance: number): Vec3 =>
  origin.map((part, k) => part + distance * (direction[k] ?? 0)) as Vec3;
const dot = (a: readonly number[], b: readonly number[]): number =>
  a.reduce((sum, part, k) => sum + part * (b[k] ?? 0), 0);
const plus = (a: readonly number[], b: readonly number[]): Vec3 => a.map((part, k) => part + (b[k] ?? 0)) as Vec3;
const minus = (a: readonly number[], b: readonly number[]): Vec3 => a.map((part, k) => part - (b[k] ?? 0)) as Vec3;

/** Where the ray enters and leaves the bounds (m along it). */
function crossing({ min, max }: Bounds, { origin, direction }: Ray): [number, number] {
  let [enters, leaves] = [0, Infinity];
  origin.forEach((from, k) => {
    const way = direction[k] ?? 0;
    if (way === 0) return;
    const [a, b] = [((min[k] ?? 0) - from) / way, ((max[k] ?? 0) - from) / way];
    enters = Math.max(enters, Math.min(a, b));
    leaves = Math.min(leaves, Math.max(a, b));
  });
  return [enters, leaves];
}

/** The place in the scene at the beginning of a point of an obstacle that moves (m). `pose`: as of writePose(). */
function atBegin({ pivot }: Obstacle, pose: Placement | undefined, place: Vec3): Vec3 {
  return pose && pivot ? plus(unplaced(pose, place), pivot) : place;
}

/** The distance of a point from a body, or from the free space in a hollow one, or less (m); negative inside it. */
function distanceFrom({ shape: { case: kind, value }, placement }: Obstacle, place: Vec3): number {
  const p = unplaced(placement, place);
  switch (kind) {
    case "plane": {
      const length = Math.hypot(...value.normal) || 1;
      return dot(minus(p, value.point), value.normal) / length;
    }
    case "box": {
      const out = p.map((part, k) => Math.max((value.min[k] ?? 0) - part, part - (value.max[k] ?? 0)));
      return Math.max(...out) > 0 ? Math.hypot(...out.map((part) => Math.max(part, 0))) : Math.max(...out);
    }
    case "sphere":
      return Math.hypot(...minus(p, value.centre)) - value.radius;
    case "cylinder":
      return distanceFromCone(fromAxis(value.from, value.to, p), value.radius, value.radius, value.open);
    case "cone":
      return distanceFromCone(fromAxis(value.from, value.to, p), value.fromRadius, value.toRadius, value.open);
    case "capsule": {
      const { height, aside, length } = fromAxis(value.from, value.to, p);
      return Math.hypot(aside, height - Math.min(Math.max(height, 0), length)) - value.radius;
    }
    case "disc": {
      const { height, aside } = fromAxis(value.centre, plus(value.centre, value.normal), p);
      return Math.hypot(height, Math.max(0, aside - value.radius, value.hole - aside));
    }
    default:
      return Infinity;
  }
}

interface FromAxis {
  height: number; // m: along the axis, from its beginning
  aside: number; // m: from the axis
  length: number; // m: of the axis
}

function fromAxis(from: readonly number[], to: readonly number[], p: Vec3): FromAxis {
  const axis = minus(to, from);
  const length = Math.hypot(...axis) || 1;
  const way = minus(p, from);
  const height = dot(way, axis) / length;
  return { height, aside: Math.sqrt(Math.max(0, dot(way, way) - height * height)), length };
}

/** `open`: of its side alone. Otherwise of the solid, or less. */
function distanceFromCone({ height, aside, length }: FromAxis, low: number, high: number, open: boolean): number {
  const slant = Math.hypot(high - low, length);
  const [out, up] = [length / slant, (high - low) / slant];
  const beyond = (aside - low) * out - height * up;
  if (!open) return Math.max(beyond, -height, height - length);
  const along = Math.min(Math.max((aside - low) * up + height * out, 0), slant);
  return Math.hypot(aside - low - along * up, height - along * out);
}

const isHollow = ({ shape: { case: kind, value } }: Obstacle): boolean =>
  (kind === "box" || kind === "sphere" || kind === "cylinder" || kind === "cone" || kind === "capsule") && value.hollow;

function poseOf({ pivot }: Obstacle, obstacle: number, state: Pick<State, "poses">): Placement | undefined {
  const pose: Placement = { turn: [0, 0, 0, 1], move: [0, 0, 0] };
  if (pivot) writePose(pose, { from: state, to: state, mix: 1 }, obstacle, pivot);
  return pivot && pose;
}

/** The first place on the ray at an obstacle, or else at the far side of the bounds (m). */
export function placeOnRay(
  facts: Pick<Facts, "min" | "max" | "obstacles">,
  ray: Ray,
  state: Pick<State, "poses">,
): Vec3 {
  const [enters, leaves] = crossing(facts, ray);
  const far = Math.max(enters, Math.min(leaves, 1e9));
  const near = 1e-4 * Math.hypot(...minus(facts.max, facts.min));
  // The ray comes through the near side of a hollow obstacle, and meets the far side: so it is followed backwards.
  const ends = facts.obstacles.map((obstacle, number) => {
    const pose = poseOf(obstacle, number, state);
    const back = isHollow(obstacle);
    let distance = back ? far : enters;
    for (let step = 0; step < mostSteps && distance >= enters && distance <= far; step++) {
      const room = distanceFrom(obstacle, atBegin(obstacle, pose, along(ray, distance)));
      if (room < near) return distance;
      distance += back ? -room : room;
    }
    return far;
  });
  return along(ray, Math.min(far, ...ends));
}

/**
 * A region for spheres above a place: against gravity, or upwards without it. `clear`: m above the place that are not
 * free.
 */
export function dropAbove(
  { min, max }: Bounds,
  gravity: readonly number[] = [],
  place: Vec3,
  clear: number,
  count: number,
  radius: number,
): Drop {
  const strength = Math.hypot(...gravity);
  const up = [0, 1, 2].map((k) => (strength > 0 ? -(gravity[k] ?? 0) / strength : Number(k === 2)));
  const volume = (count * (4 / 3) * Math.PI * radius ** 3) / fill;
  const side = 2.2 * radius + (count > 1 ? Math.cbrt(volume) : 0); // centres keep a radius from its faces
  // The axis that is nearest to the direction upwards: the region is a box along the axes.
  const axis = up.reduce((best, part, k) => (Math.abs(part) > Math.abs(up[best] ?? 0) ? k : best), 0);
  const low: number[] = [];
  const high: number[] = [];
  for (let k = 0; k < 3; k++) {
    const [least, most] = [(min[k] ?? 0) + margin * radius, (max[k] ?? 0) - margin * radius];
    const at = place[k] ?? 0;
    const lift = clear + margin * radius + side / 2;
    const middle = k === axis ? at + Math.sign(up[k] ?? 1) * lift : at;
    const width = Math.min(side, Math.max(0, most - least));
    const from = Math.max(least, Math.min(middle - width / 2, most - width));
    low.push(from);
    high.push(Math.max(from + width, from + 1e-9));
  }
  return { min: low, max: high, count, radius };
}
