import type { Drop } from "../connection/commands";
import type { Facts, Vec3 } from "../scene/facts";

// Of water, a material's default. The server tells no densities, and the impulse is only a first offer that the person
// may change: most solids and liquids are near enough for it to be felt and to do no harm.
const density = 1000; // kg/m³
const kick = 3; // m/s that the impulse offered gives a sphere of that density

/** What the person should know of the impulse offered. */
export const impulseNote = `At first what gives a sphere of the scene's middle size ${kick} m/s at ${density} kg/m³; denser ones need more`;

/** An impulse, in N s, for a sphere of this radius in m; two significant digits. */
export function impulseFor(radius: number): number {
  return Number((kick * density * (4 / 3) * Math.PI * radius ** 3).toPrecision(2));
}

/** Where spheres are dropped: the upper third of the bounds, clear of its walls. */
export function dropFor(facts: Facts, count: number, radius: number): Drop {
  const margin = 1.1 * radius;
  const min = facts.min.map((low) => low + margin) as Vec3;
  const max = facts.max.map((high) => high - margin) as Vec3;
  min[2] = Math.min(max[2], facts.max[2] - (facts.max[2] - facts.min[2]) / 3);
  return { min, max, count, radius };
}
