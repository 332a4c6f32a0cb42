import type { Facts, Vec3 } from "./facts";
import type { Shown, State } from "./states";

/** The position of the sphere at a place in a state (m). It is off by at most half a quantum on each axis. */
export function positionOf(facts: Facts, state: State, place: number): Vec3 {
  const at = 3 * place;
  const { origin } = facts;
  const { values } = state.columns.position;
  return [origin[0] + (values[at] ?? 0), origin[1] + (values[at + 1] ?? 0), origin[2] + (values[at + 2] ?? 0)];
}

/** The distance along an axis by the shortest way (m). `period`: length of the axis if it is periodic, else 0. */
function shortest(distance: number, period: number): number {
  return period > 0 ? distance - period * Math.floor(distance / period + 0.5) : distance;
}

/** The position at which a sphere is drawn (m). Along a periodic axis, it moves by the shortest way. */
export function shownPosition(facts: Facts, shown: Shown, place: number): Vec3 {
  const at = 3 * place;
  const { values: from } = shown.from.columns.position;
  const { values: to } = shown.to.columns.position;
  return facts.origin.map((origin, axis) => {
    const period = facts.periods[axis] ?? 0;
    const begin = from[at + axis] ?? 0;
    return origin + shortest(begin + shown.mix * shortest((to[at + axis] ?? 0) - begin, period), period);
  }) as Vec3;
}

/**
 * The positions at which a sphere is drawn (m): one that reaches across a face of a periodic axis is drawn at both
 * faces.
 */
export function shownImages(facts: Facts, shown: Shown, place: number): Vec3[] {
  const images = [shownPosition(facts, shown, place)];
  facts.periods.forEach((period, axis) => {
    if (period === 0) return;
    const from = (images[0]?.[axis] ?? 0) - (facts.origin[axis] ?? 0);
    if (Math.abs(from) + facts.population.radiusOf(place) <= period / 2) return;
    for (const image of [...images]) {
      const other: Vec3 = [...image];
      other[axis] = (image[axis] ?? 0) - Math.sign(from) * period;
      images.push(other);
    }
  });
  return images;
}

/** The mean speed of a sphere between two states of different times (m/s). */
function speedOf(facts: Facts, from: State, to: State, place: number): number {
  const time = to.simTime - from.simTime;
  const at = 3 * place;
  const { values: a } = from.columns.position;
  const { values: b } = to.columns.position;
  const [x, y, z] = facts.periods;
  const dx = shortest((b[at] ?? 0) - (a[at] ?? 0), x);
  const dy = shortest((b[at + 1] ?? 0) - (a[at + 1] ?? 0), y);
  const dz = shortest((b[at + 2] ?? 0) - (a[at + 2] ?? 0), z);
  return Math.hypot(dx, dy, dz) / time;
}

/**
 * The speed of a sphere (m/s): the one that the server sent, or the mean between the two states, which is off by at
 * most `error` because positions are quantised. Undefined: unknown.
 */
export function shownSpeed(
  facts: Facts,
  { from, to, mix }: Shown,
  place: number,
): { speed: number; error: number } | undefined {
  const before = from.columns.speed?.values[place];
  const after = to.columns.speed?.values[place];
  if (before !== undefined && after !== undefined) return { speed: before + mix * (after - before), error: 0 };
  const time = to.simTime - from.simTime;
  if (!(time > 0)) return undefined;
  const quanta = from.columns.position.quantum + to.columns.position.quantum;
  return { speed: speedOf(facts, from, to, place), error: (Math.sqrt(3) / 2) * (quanta / time) };
}
