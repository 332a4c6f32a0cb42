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
  const x = base[0] as number;
  const y = base[1] as number;
  const z = base[2] as number;
  // What a predictor takes of the step. Each sum is cut to 32 bits at once, so that the engine has no need of wider numbers.
  const keep = predictor === none ? 0 : -1;
  const mask = predictor === linear || predictor === half ? -1 : 0;
  const shift = predictor === half ? 1 : 0;
  for (let k = 0, to = at; k < 64; k++, to += 3) {
    const a = values[k] as number;
    const b = values[k + 64] as number;
    const c = values[k + 128] as number;
    const qa = newest[to] as number;
    const qb = newest[to + 1] as number;
    const qc = newest[to + 2] as number;
    const sa = (((qa - (before[to] as number)) | 0) >> shift) & mask;
    const sb = (((qb - (before[to + 1] as number)) | 0) >> shift) & mask;
    const sc = (((qc - (before[to + 2] as number)) | 0) >> shift) & mask;
    before[to] = (((((a >>> 1) ^ -(a & 1)) + x) | 0) + (((qa & keep) + sa) | 0)) | 0;
    before[to + 1] = (((((b >>> 1) ^ -(b & 1)) + y) | 0) + (((qb & keep) + sb) | 0)) | 0;
    before[to + 2] = (((((c >>> 1) ^ -(c & 1)) + z) | 0) + (((qc & keep) + sc) | 0)) | 0;
  }
}
