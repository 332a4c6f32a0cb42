import type { Drop } from "../connection/commands";
import type { Settings } from "../gen/spherule/v1/control_pb";
import type { Facts, Vec3 } from "../model/facts";
import type { EntryRule } from "./entry";

/** Gravity (m/s²) by name. */
export const gravityPresets: Record<string, Vec3> = {
  Earth: [0, 0, -9.81],
  Moon: [0, 0, -1.62],
  Zero: [0, 0, 0],
  Sideways: [6.94, 0, -6.94], // as strong as on Earth
};

export const customGravity = "Custom";

export function gravityPresetOf(gravity: Vec3): string {
  const same = (preset: Vec3): boolean => preset.every((part, axis) => Math.abs(part - (gravity[axis] ?? 0)) < 5e-3);
  return Object.keys(gravityPresets).find((name) => same(gravityPresets[name] ?? [0, 0, 0])) ?? customGravity;
}

// The density of water, which is the default of materials. The server does not send densities. The impulse is only a
// first value, which the user can change, and it fits most solids and liquids.
const density = 1000; // kg/m³
const pushSpeed = 3; // m/s that the first impulse gives to a sphere of that density

export const impulseNote =
  `The first value gives a sphere of the scene's mean radius ${pushSpeed} m/s at ${density} kg/m³. ` +
  "Denser spheres need more";

/** The first impulse (N s) for spheres of this radius (m), rounded to two significant digits. */
export function impulseFor(radius: number): number {
  return Number((pushSpeed * density * (4 / 3) * Math.PI * radius ** 3).toPrecision(2));
}

/** The first radius (m) of dropped spheres: the mean of the moving ones, or a small part of the largest that fits. */
export function dropRadiusFor(facts: Facts): number {
  const most = dropRadiusRule(facts).most ?? Infinity;
  return Number(Math.min(facts.population.meanRadius || most / 20, most).toPrecision(3));
}

type Bounds = Pick<Facts, "min" | "max">;

/** The radii (m) of spheres that dropFor() can place. */
export function dropRadiusRule(facts: Bounds | undefined): EntryRule {
  const sides = facts ? facts.max.map((high, axis) => high - (facts.min[axis] ?? 0)) : [2e6];
  return { unit: "m", least: 1e-6, most: Number((Math.min(...sides) / (2 * dropMargin + dropRoom)).toPrecision(2)) };
}

// The largest impulse that the server takes raises the substeps up to 256 times, for all spheres: steps then take
// seconds. This share of it raises them 16 times.
const shareOfImpulse = 1 / 16;

/** The impulses that the page offers. There is no limit as long as the server has told none. */
export function impulseRule(settings: Pick<Settings, "maxImpulse"> | undefined): EntryRule {
  const most = shareOfImpulse * (settings?.maxImpulse ?? 0);
  return { unit: "N s", above: 0, most: most > 0 ? Number(most.toPrecision(2)) : undefined };
}

const dropMargin = 1.1; // radii between dropped spheres and the bounds
const dropRoom = 2.2; // radii: the least side of the box for them

/** Spheres to drop in the upper third of the bounds, clear of its walls. The box is higher for large spheres. */
export function dropFor(facts: Bounds, count: number, radius: number): Drop {
  const margin = dropMargin * radius;
  const min = facts.min.map((low) => low + margin) as Vec3;
  const max = facts.max.map((high) => high - margin) as Vec3;
  const third = facts.max[2] - (facts.max[2] - facts.min[2]) / 3;
  min[2] = Math.max(min[2], Math.min(third, max[2] - dropRoom * radius));
  return { min, max, count, radius };
}

const mostDropped = 200;
const fill = 0.1; // of the space: so many random places without overlaps are soon found

/** The first number of spheres to drop: a round one, fewer where there is little room. `radius`: of them (m). */
export function dropCountFor(facts: Bounds, radius: number): number {
  const { min, max } = dropFor(facts, 1, radius);
  const room = min.reduce((volume, low, axis) => volume * Math.max(0, (max[axis] ?? low) - low), 1);
  const fitting = Number(((fill * room) / ((4 / 3) * Math.PI * radius ** 3)).toPrecision(1));
  return Math.max(1, Math.min(mostDropped, Math.floor(fitting)));
}
