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
    const middle = base[axis] as number;
    let from = 64 * axis;
    const end = from + 64;
    let to = at + axis;
    // Each sum is cut to 32 bits at once, so that the engine has no need of wider numbers.
    switch (predictor) {
      case linear:
        for (; from < end; from++, to += 3) {
          const v = values[from] as number;
          const q = newest[to] as number;
          const step = (q - (before[to] as number)) | 0;
          const r = (((v >>> 1) ^ -(v & 1)) + middle) | 0;
          before[to] = (((q + step) | 0) + r) | 0;
        }
        break;
      case half:
        for (; from < end; from++, to += 3) {
          const v = values[from] as number;
          const q = newest[to] as number;
          const step = ((q - (before[to] as number)) | 0) >> 1;
          const r = (((v >>> 1) ^ -(v & 1)) + middle) | 0;
          before[to] = (((q + step) | 0) + r) | 0;
        }
        break;
      case none:
        for (; from < end; from++, to += 3) {
          const v = values[from] as number;
          before[to] = (((v >>> 1) ^ -(v & 1)) + middle) | 0;
        }
        break;
      default:
        for (; from < end; from++, to += 3) {
          const v = values[from] as number;
          const r = (((v >>> 1) ^ -(v & 1)) + middle) | 0;
          before[to] = ((newest[to] as number) + r) | 0;
        }
    }
  }
}
