import { half, linear, previous } from "./format";

type Predict = (values: Int32Array, x: number, y: number, z: number, newest: Int32Array, before: Int32Array, at: number) => void;

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
  const by = predictor === previous ? fromPrevious : predictor === linear ? fromLinear : predictor === half ? fromHalf : fromNone;
  by(values, x, y, z, newest, before, at);
}

// One loop for each predictor: none asks again for each sphere. Each sum is cut to 32 bits at once, so that the engine has no
// need of wider numbers.

const fromPrevious: Predict = (values, x, y, z, newest, before, at) => {
  for (let k = 0, to = at; k < 64; k++, to += 3) {
    const a = values[k] as number;
    const b = values[k + 64] as number;
    const c = values[k + 128] as number;
    before[to] = (((newest[to] as number) + x) | 0) + ((a >>> 1) ^ -(a & 1));
    before[to + 1] = (((newest[to + 1] as number) + y) | 0) + ((b >>> 1) ^ -(b & 1));
    before[to + 2] = (((newest[to + 2] as number) + z) | 0) + ((c >>> 1) ^ -(c & 1));
  }
};

const fromLinear: Predict = (values, x, y, z, newest, before, at) => {
  for (let k = 0, to = at; k < 64; k++, to += 3) {
    const a = values[k] as number;
    const b = values[k + 64] as number;
    const c = values[k + 128] as number;
    const pa = (((newest[to] as number) << 1) - (before[to] as number)) | 0;
    const pb = (((newest[to + 1] as number) << 1) - (before[to + 1] as number)) | 0;
    const pc = (((newest[to + 2] as number) << 1) - (before[to + 2] as number)) | 0;
    before[to] = (((pa + x) | 0) + ((a >>> 1) ^ -(a & 1))) | 0;
    before[to + 1] = (((pb + y) | 0) + ((b >>> 1) ^ -(b & 1))) | 0;
    before[to + 2] = (((pc + z) | 0) + ((c >>> 1) ^ -(c & 1))) | 0;
  }
};

const fromHalf: Predict = (values, x, y, z, newest, before, at) => {
  for (let k = 0, to = at; k < 64; k++, to += 3) {
    const a = values[k] as number;
    const b = values[k + 64] as number;
    const c = values[k + 128] as number;
    const qa = newest[to] as number;
    const qb = newest[to + 1] as number;
    const qc = newest[to + 2] as number;
    const pa = (qa + (((qa - (before[to] as number)) | 0) >> 1)) | 0;
    const pb = (qb + (((qb - (before[to + 1] as number)) | 0) >> 1)) | 0;
    const pc = (qc + (((qc - (before[to + 2] as number)) | 0) >> 1)) | 0;
    before[to] = (((pa + x) | 0) + ((a >>> 1) ^ -(a & 1))) | 0;
    before[to + 1] = (((pb + y) | 0) + ((b >>> 1) ^ -(b & 1))) | 0;
    before[to + 2] = (((pc + z) | 0) + ((c >>> 1) ^ -(c & 1))) | 0;
  }
};

const fromNone: Predict = (values, x, y, z, _newest, before, at) => {
  for (let k = 0, to = at; k < 64; k++, to += 3) {
    const a = values[k] as number;
    const b = values[k + 64] as number;
    const c = values[k + 128] as number;
    before[to] = ((a >>> 1) ^ -(a & 1)) + x;
    before[to + 1] = ((b >>> 1) ^ -(b & 1)) + y;
    before[to + 2] = ((c >>> 1) ^ -(c & 1)) + z;
  }
};
