import type { Positions } from "../columns";
import type { Run } from "./population";

/**
 * Positions in states are whole numbers of quanta, relative to the centre of the bounds. Here the page makes metres of
 * them, in double precision. renderer/shaders/spheres.glsl does that for the image.
 */

export const axes = [0, 1, 2] as const;

const largest = 2 ** 30 - 1; // the difference of two such numbers is below 2^31

/** The whole number of quanta that is nearest to a length (m). */
export function unitsOf(metres: number, quantum: number): number {
  return Math.min(Math.max(Math.round(metres / quantum), -largest), largest);
}

/** A coordinate of the sphere at a place (m, relative to the centre of the bounds). */
export function coordinate({ values, quanta }: Positions, place: number, axis: (typeof axes)[number]): number {
  return (values[3 * place + axis] ?? 0) * quanta[axis];
}

/** Copies the positions of consecutive places to another state. If it has other quanta, they are rounded to these. */
export function copyPositions(from: Positions, to: Positions, { first, count }: Run): void {
  for (let place = first; place < first + count; place++) {
    for (const axis of axes) {
      to.values[3 * place + axis] = unitsOf(coordinate(from, place, axis), to.quanta[axis]);
    }
  }
}
