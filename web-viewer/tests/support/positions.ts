import type { Positions } from "../../src/columns";
import { noTurns } from "../../src/codec/turns";

/** Positions in a state, from coordinates (m, relative to the centre of the bounds). */
export function positionsAt(metres: readonly number[], quantum = 0.01): Positions {
  const values = Int32Array.from(metres, (x) => Math.round(x / quantum));
  return { values, quantum, quanta: [quantum, quantum, quantum], turns: noTurns };
}
