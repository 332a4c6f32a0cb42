import type { Facts, Vec3 } from "./facts";
import type { Shown, State } from "./states";

/** The position of a sphere in a state (m). It is off by at most half a quantum on each axis. */
export function positionOf(facts: Facts, state: State, id: number): Vec3 {
  const at = 3 * id;
  const { origin } = facts;
  const { values } = state.columns.position;
  return [origin[0] + (values[at] ?? 0), origin[1] + (values[at + 1] ?? 0), origin[2] + (values[at + 2] ?? 0)];
}

/** The position at which a sphere is drawn (m). */
export function shownPosition(facts: Facts, shown: Shown, id: number): Vec3 {
  const a = positionOf(facts, shown.from, id);
  const b = positionOf(facts, shown.to, id);
  return [0, 1, 2].map((axis) => (a[axis] ?? 0) + shown.mix * ((b[axis] ?? 0) - (a[axis] ?? 0))) as Vec3;
}

/** The mean speed of a sphere between two states (m/s); 0 if no simulated time passed. */
export function speedOf(from: State, to: State, id: number): number {
  const time = to.simTime - from.simTime;
  if (!(time > 0)) return 0;
  const at = 3 * id;
  const { values: a } = from.columns.position;
  const { values: b } = to.columns.position;
  const dx = (b[at] ?? 0) - (a[at] ?? 0);
  const dy = (b[at + 1] ?? 0) - (a[at + 1] ?? 0);
  const dz = (b[at + 2] ?? 0) - (a[at + 2] ?? 0);
  return Math.hypot(dx, dy, dz) / time;
}

/** The smallest speed that quantised states can show (m/s). */
export function leastSpeed(from: State, to: State): number {
  const time = to.simTime - from.simTime;
  return time > 0 ? Math.max(from.columns.position.quantum, to.columns.position.quantum) / time : 0;
}
