import type { Facts, Vec3 } from "./facts";
import type { Shown, State } from "./states";

/** The position of a sphere in a state (m). It is off by at most half a quantum on each axis. */
export function positionOf(facts: Facts, state: State, id: number): Vec3 {
  const at = 3 * id;
  const { origin } = facts;
  return [
    origin[0] + (state.positions[at] ?? 0),
    origin[1] + (state.positions[at + 1] ?? 0),
    origin[2] + (state.positions[at + 2] ?? 0),
  ];
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
  const dx = (to.positions[at] ?? 0) - (from.positions[at] ?? 0);
  const dy = (to.positions[at + 1] ?? 0) - (from.positions[at + 1] ?? 0);
  const dz = (to.positions[at + 2] ?? 0) - (from.positions[at + 2] ?? 0);
  return Math.hypot(dx, dy, dz) / time;
}

/** The smallest speed that quantised states can show (m/s). */
export function leastSpeed(from: State, to: State): number {
  const time = to.simTime - from.simTime;
  return time > 0 ? Math.max(from.quantum, to.quantum) / time : 0;
}

/** The 98th percentile of speed (m/s), from at most `samples` spheres spread over the ids. */
export function highSpeed(from: State, to: State, samples = 2048): number {
  const count = Math.min(from.count, to.count);
  if (count === 0) return 0;
  const speeds = new Float64Array(Math.min(samples, count));
  for (let i = 0; i < speeds.length; i++) {
    speeds[i] = speedOf(from, to, Math.floor((i * count) / speeds.length));
  }
  return speeds.sort()[Math.floor(0.98 * (speeds.length - 1))] ?? 0;
}
