import { blockSpheres } from "./format";

/**
 * Per axis, the grid cells in the length of a periodic axis, modulo which coordinates are counted; 0: they are not.
 */
export type Turns = readonly [number, number, number];

export const noTurns: Turns = [0, 0, 0];

export function sameTurns(a: Turns, b: Turns): boolean {
  return a.every((turns, axis) => turns === b[axis]);
}

/** The number that differs from `value` by a multiple of `turns` and is nearest to 0. */
export function nearest(value: number, turns: number): number {
  const half = turns >>> 1;
  const rest = (value + half) % turns;
  return (rest < 0 ? rest + turns : rest) - half;
}

/** Chooses the images of a block's older positions that are nearest to the newest ones. `at`: its first value. */
export function shortenSteps(turns: Turns, newest: Int32Array, before: Int32Array, at: number): void {
  for (let axis = 0; axis < 3; axis++) {
    const each = turns[axis] as number;
    if (each === 0) continue;
    for (let k = at + axis; k < at + 3 * blockSpheres; k += 3) {
      const now = newest[k] as number;
      before[k] = now - nearest((now - (before[k] as number)) | 0, each);
    }
  }
}

/** Moves the positions of a block to their images around 0. */
export function moveBack(turns: Turns, positions: Int32Array, at: number): void {
  for (let axis = 0; axis < 3; axis++) {
    const each = turns[axis] as number;
    if (each === 0) continue;
    for (let k = at + axis; k < at + 3 * blockSpheres; k += 3) positions[k] = nearest(positions[k] as number, each);
  }
}
