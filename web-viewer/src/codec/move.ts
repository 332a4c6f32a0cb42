import { half, linear, previous } from "./format";

/**
 * Moves the spheres of a block by the values of its runs. A run has the values of eight spheres on one axis. The runs
 * begin at `byte`, by axis and run; `width` is their number of bits per value, and `base` is added to each value.
 * `newest` and `before` hold the positions of the last two frames, x y z per sphere, with the block's first sphere at
 * `at`. The new positions replace those in `before`. `view` must have eight more bytes after the values.
 */
export function move(
  predictor: number,
  view: DataView,
  byte: number,
  width: Uint8Array,
  base: Int32Array,
  newest: Int32Array,
  before: Int32Array,
  at: number,
): void {
  const predicted = predictor === linear ? fromLinear : predictor === half ? fromHalf : fromNone;
  const by = predictor === previous ? fromPrevious : predicted;
  by(view, byte, width, base, newest, before, at);
}

type Move = (
  view: DataView,
  byte: number,
  width: Uint8Array,
  base: Int32Array,
  newest: Int32Array,
  before: Int32Array,
  at: number,
) => void;

// This code takes most of the time of a frame, so it is written for speed:
// - Each predictor has its own function, which reads and moves in one pass. There is no branch per sphere, and no value
//   is stored in between.
// - The eight spheres of a run are written out, which is a tenth faster than a loop. Runs without values have their own
//   branch.
// - A run has as many bytes as a value has bits, and begins at a byte. One read of 32 bits therefore contains four
//   values of up to 8 bits, or one value of any width.
// - Each sum is truncated to 32 bits at once, so that the engine uses integers.

/** Decodes a zigzag value: 0, 1, 2, 3 stand for 0, -1, 1, -2. */
function signed(value: number): number {
  return (value >>> 1) ^ -(value & 1);
}

/** Linear extrapolation from the last two positions. */
function onwards(now: number, last: number, middle: number): number {
  return ((((now << 1) - last) | 0) + middle) | 0;
}

/** Extrapolation by half of the last step. */
function halfway(now: number, last: number, middle: number): number {
  return (((now + ((now - last) >> 1)) | 0) + middle) | 0;
}

/** The value that begins `bit` bits (at most 255) after the start of a run at `byte`. Works for every width. */
function wideValue(view: DataView, byte: number, bit: number, width: number): number {
  const all = view.getInt32(byte + (bit >> 3), true);
  return width === 32 ? all : (all >>> (bit & 7)) & ((1 << width) - 1);
}

const fromPrevious: Move = (view, byte, width, base, newest, before, at) => {
  for (let axis = 0; axis < 3; axis++) {
    const middle = base[axis] as number;
    for (let run = 8 * axis, to = at + axis; run < 8 * axis + 8; run++, to += 24) {
      const wide = width[run] as number;
      if (wide === 0) {
        before[to] = (newest[to] as number) + middle;
        before[to + 3] = (newest[to + 3] as number) + middle;
        before[to + 6] = (newest[to + 6] as number) + middle;
        before[to + 9] = (newest[to + 9] as number) + middle;
        before[to + 12] = (newest[to + 12] as number) + middle;
        before[to + 15] = (newest[to + 15] as number) + middle;
        before[to + 18] = (newest[to + 18] as number) + middle;
        before[to + 21] = (newest[to + 21] as number) + middle;
      } else if (wide <= 8) {
        const mask = (1 << wide) - 1;
        let four = view.getInt32(byte, true);
        before[to] = (((newest[to] as number) + middle) | 0) + signed(four & mask);
        before[to + 3] = (((newest[to + 3] as number) + middle) | 0) + signed((four >>>= wide) & mask);
        before[to + 6] = (((newest[to + 6] as number) + middle) | 0) + signed((four >>>= wide) & mask);
        before[to + 9] = (((newest[to + 9] as number) + middle) | 0) + signed((four >>>= wide) & mask);
        four = view.getInt32(byte + (wide >> 1), true) >>> (4 * (wide & 1));
        before[to + 12] = (((newest[to + 12] as number) + middle) | 0) + signed(four & mask);
        before[to + 15] = (((newest[to + 15] as number) + middle) | 0) + signed((four >>>= wide) & mask);
        before[to + 18] = (((newest[to + 18] as number) + middle) | 0) + signed((four >>>= wide) & mask);
        before[to + 21] = (((newest[to + 21] as number) + middle) | 0) + signed((four >>>= wide) & mask);
      } else {
        for (let k = to, bit = 0; k < to + 24; k += 3, bit += wide) {
          before[k] = (((newest[k] as number) + middle) | 0) + signed(wideValue(view, byte, bit, wide));
        }
      }
      byte += wide;
    }
  }
};

const fromLinear: Move = (view, byte, width, base, newest, before, at) => {
  for (let axis = 0; axis < 3; axis++) {
    const middle = base[axis] as number;
    for (let run = 8 * axis, to = at + axis; run < 8 * axis + 8; run++, to += 24) {
      const wide = width[run] as number;
      if (wide === 0) {
        before[to] = onwards(newest[to] as number, before[to] as number, middle);
        before[to + 3] = onwards(newest[to + 3] as number, before[to + 3] as number, middle);
        before[to + 6] = onwards(newest[to + 6] as number, before[to + 6] as number, middle);
        before[to + 9] = onwards(newest[to + 9] as number, before[to + 9] as number, middle);
        before[to + 12] = onwards(newest[to + 12] as number, before[to + 12] as number, middle);
        before[to + 15] = onwards(newest[to + 15] as number, before[to + 15] as number, middle);
        before[to + 18] = onwards(newest[to + 18] as number, before[to + 18] as number, middle);
        before[to + 21] = onwards(newest[to + 21] as number, before[to + 21] as number, middle);
      } else if (wide <= 8) {
        const mask = (1 << wide) - 1;
        let four = view.getInt32(byte, true);
        before[to] = onwards(newest[to] as number, before[to] as number, middle) + signed(four & mask);
        before[to + 3] =
          onwards(newest[to + 3] as number, before[to + 3] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 6] =
          onwards(newest[to + 6] as number, before[to + 6] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 9] =
          onwards(newest[to + 9] as number, before[to + 9] as number, middle) + signed((four >>>= wide) & mask);
        four = view.getInt32(byte + (wide >> 1), true) >>> (4 * (wide & 1));
        before[to + 12] = onwards(newest[to + 12] as number, before[to + 12] as number, middle) + signed(four & mask);
        before[to + 15] =
          onwards(newest[to + 15] as number, before[to + 15] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 18] =
          onwards(newest[to + 18] as number, before[to + 18] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 21] =
          onwards(newest[to + 21] as number, before[to + 21] as number, middle) + signed((four >>>= wide) & mask);
      } else {
        for (let k = to, bit = 0; k < to + 24; k += 3, bit += wide) {
          before[k] =
            onwards(newest[k] as number, before[k] as number, middle) + signed(wideValue(view, byte, bit, wide));
        }
      }
      byte += wide;
    }
  }
};

const fromHalf: Move = (view, byte, width, base, newest, before, at) => {
  for (let axis = 0; axis < 3; axis++) {
    const middle = base[axis] as number;
    for (let run = 8 * axis, to = at + axis; run < 8 * axis + 8; run++, to += 24) {
      const wide = width[run] as number;
      if (wide === 0) {
        before[to] = halfway(newest[to] as number, before[to] as number, middle);
        before[to + 3] = halfway(newest[to + 3] as number, before[to + 3] as number, middle);
        before[to + 6] = halfway(newest[to + 6] as number, before[to + 6] as number, middle);
        before[to + 9] = halfway(newest[to + 9] as number, before[to + 9] as number, middle);
        before[to + 12] = halfway(newest[to + 12] as number, before[to + 12] as number, middle);
        before[to + 15] = halfway(newest[to + 15] as number, before[to + 15] as number, middle);
        before[to + 18] = halfway(newest[to + 18] as number, before[to + 18] as number, middle);
        before[to + 21] = halfway(newest[to + 21] as number, before[to + 21] as number, middle);
      } else if (wide <= 8) {
        const mask = (1 << wide) - 1;
        let four = view.getInt32(byte, true);
        before[to] = halfway(newest[to] as number, before[to] as number, middle) + signed(four & mask);
        before[to + 3] =
          halfway(newest[to + 3] as number, before[to + 3] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 6] =
          halfway(newest[to + 6] as number, before[to + 6] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 9] =
          halfway(newest[to + 9] as number, before[to + 9] as number, middle) + signed((four >>>= wide) & mask);
        four = view.getInt32(byte + (wide >> 1), true) >>> (4 * (wide & 1));
        before[to + 12] = halfway(newest[to + 12] as number, before[to + 12] as number, middle) + signed(four & mask);
        before[to + 15] =
          halfway(newest[to + 15] as number, before[to + 15] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 18] =
          halfway(newest[to + 18] as number, before[to + 18] as number, middle) + signed((four >>>= wide) & mask);
        before[to + 21] =
          halfway(newest[to + 21] as number, before[to + 21] as number, middle) + signed((four >>>= wide) & mask);
      } else {
        for (let k = to, bit = 0; k < to + 24; k += 3, bit += wide) {
          before[k] =
            halfway(newest[k] as number, before[k] as number, middle) + signed(wideValue(view, byte, bit, wide));
        }
      }
      byte += wide;
    }
  }
};

const fromNone: Move = (view, byte, width, base, _newest, before, at) => {
  for (let axis = 0; axis < 3; axis++) {
    const middle = base[axis] as number;
    for (let run = 8 * axis, to = at + axis; run < 8 * axis + 8; run++, to += 24) {
      const wide = width[run] as number;
      for (let k = to, bit = 0; k < to + 24; k += 3, bit += wide) {
        before[k] = middle + signed(wideValue(view, byte, bit, wide));
      }
      byte += wide;
    }
  }
};
