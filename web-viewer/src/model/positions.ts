import { Quantity } from "../gen/spherule/v1/frame_pb";
import type { Facts, Vec3 } from "./facts";
import type { Shown, State } from "./states";
import { axes, coordinate } from "./units";

/** The position of the sphere at a place in a state (m). It is off by at most half a quantum on each axis. */
export function positionOf({ origin }: Facts, { columns: { position } }: State, place: number): Vec3 {
  const [x, y, z] = origin;
  return [x + coordinate(position, place, 0), y + coordinate(position, place, 1), z + coordinate(position, place, 2)];
}

/** The distance along an axis by the shortest way (m). `period`: length of the axis if it is periodic, else 0. */
function shortest(distance: number, period: number): number {
  return period > 0 ? distance - period * Math.floor(distance / period + 0.5) : distance;
}

/** The position at which a sphere is drawn (m). Along a periodic axis, it moves by the shortest way. */
export function shownPosition(facts: Facts, shown: Shown, place: number): Vec3 {
  const at = writePosition([0, 0, 0], facts, shown, place, shown.mix);
  for (let axis = 0; axis < 3; axis++) at[axis] = (at[axis] as number) + (facts.origin[axis] as number);
  return at;
}

/** Writes the position between two states (m, relative to the centre of the bounds) to `into`; `mix`: as in Shown. */
export function writePosition(into: Vec3, { periods }: Facts, { from, to }: Shown, place: number, mix: number): Vec3 {
  for (const axis of axes) {
    const period = periods[axis];
    const begin = coordinate(from.columns.position, place, axis);
    const end = coordinate(to.columns.position, place, axis);
    into[axis] = shortest(begin + mix * shortest(end - begin, period), period);
  }
  return into;
}

/** The height of a sphere's centre above the lower face of the bounds (m). It allocates nothing. */
export function heightOf({ min, origin }: Facts, { from, to, mix }: Shown, place: number): number {
  if (place >= from.count || place >= to.count) return NaN;
  const begin = coordinate(from.columns.position, place, 2);
  const end = coordinate(to.columns.position, place, 2);
  return begin + mix * (end - begin) + origin[2] - min[2];
}

/** Whether the server sent this quantity in both states. */
export function isSent(quantity: Quantity, { from, to }: Shown): boolean {
  return from.columns.value?.quantity === quantity && to.columns.value?.quantity === quantity;
}

/** A quantity of a sphere that the server sent; NaN: it sent none. It allocates nothing. */
export function sentValue(quantity: Quantity, shown: Shown, place: number): number {
  if (!isSent(quantity, shown)) return NaN;
  const before = shown.from.columns.value?.values[place] ?? NaN;
  const after = shown.to.columns.value?.values[place] ?? NaN;
  return before + shown.mix * (after - before);
}

/**
 * The speed of a sphere (m/s): the one that the server sent, or the mean between the two states. NaN: unknown. It
 * allocates nothing.
 */
export function speedOf(facts: Facts, shown: Shown, place: number): number {
  const sent = sentValue(Quantity.SPEED, shown, place);
  if (!Number.isNaN(sent)) return sent;
  const { from, to } = shown;
  const time = to.simTime - from.simTime;
  if (!(time > 0)) return NaN;
  const { position: a } = from.columns;
  const { position: b } = to.columns;
  const { periods } = facts;
  const dx = shortest(coordinate(b, place, 0) - coordinate(a, place, 0), periods[0]);
  const dy = shortest(coordinate(b, place, 1) - coordinate(a, place, 1), periods[1]);
  const dz = shortest(coordinate(b, place, 2) - coordinate(a, place, 2), periods[2]);
  return Math.sqrt(dx * dx + dy * dy + dz * dz) / time;
}

/**
 * The speed of a sphere (m/s): the one that the server sent, or the mean between the two states, which is off by at
 * most `error` because positions are quantised. Undefined: unknown.
 */
export function shownSpeed(facts: Facts, shown: Shown, place: number): { speed: number; error: number } | undefined {
  const speed = speedOf(facts, shown, place);
  if (Number.isNaN(speed)) return undefined;
  const { from, to } = shown;
  if (isSent(Quantity.SPEED, shown)) return { speed, error: 0 };
  const quanta = from.columns.position.quantum + to.columns.position.quantum;
  return { speed, error: (Math.sqrt(3) / 2) * (quanta / (to.simTime - from.simTime)) };
}
