import { half, linear, none } from "./format";

/**
 * New positions of a block from its values, 64 x, 64 y, 64 z: into `before`, which holds those of the frame before the
 * newest; both x y z for sphere after sphere, the block's first at `at`.
 */
export function predict(
  predictor: number,
  values: Int32Array,
  base: Int32Array,
  newest: Int32Array,
  before: Int32Array,
  at: number,
): void {
  for (let axis = 0; axis < 3; axis++) {
    const from = 64 * axis;
    const middle = base[axis] as number;
    let to = at + axis;
    switch (predictor) {
      case linear:
        for (let k = from; k < from + 64; k++, to += 3) {
          const v = values[k] as number;
          before[to] = 2 * (newest[to] as number) - (before[to] as number) + ((v >>> 1) ^ -(v & 1)) + middle;
        }
        break;
      case half:
        for (let k = from; k < from + 64; k++, to += 3) {
          const v = values[k] as number;
          const q = newest[to] as number;
          before[to] = q + ((q - (before[to] as number)) >> 1) + ((v >>> 1) ^ -(v & 1)) + middle;
        }
        break;
      case none:
        for (let k = from; k < from + 64; k++, to += 3) {
          const v = values[k] as number;
          before[to] = ((v >>> 1) ^ -(v & 1)) + middle;
        }
        break;
      default:
        for (let k = from; k < from + 64; k++, to += 3) {
          const v = values[k] as number;
          before[to] = (newest[to] as number) + ((v >>> 1) ^ -(v & 1)) + middle;
        }
    }
  }
}
