import { modeBase, modeMask, modeRuns, none, previous, widths } from "./format";
import { predict } from "./predict";
import { bitCount, readChanged, readRun } from "./values";

/** Bits of the values of a run, by its axis's width code and its selector. */
const narrowed = Uint8Array.from({ length: 64 }, (_, k) => widths[Math.max(0, (k >> 2) - (k & 3))] as number);

/** Reads blocks, one after another; nothing is allocated per block. */
export class BlockReader {
  private readonly width = new Uint8Array(24); // bits, by axis and run
  private readonly changed = new Uint8Array(24); // mode mask: bit per value
  private readonly base = new Int32Array(3);
  private readonly values = new Int32Array(192);
  /** What is wrong with the block, where `read` gave -1. */
  fault = "";

  /**
   * The block at `unit` (16 bits): its new positions go into `before` at `at`. Gives the unit behind it, or -1 where it
   * goes beyond the unit `end` or breaks the rules of keyframes. `words` has two words behind `end`.
   */
  read(
    words: Uint32Array,
    unit: number,
    end: number,
    keyframe: boolean,
    velocities: boolean,
    newest: Int32Array,
    before: Int32Array,
    at: number,
  ): number {
    if (unit >= end) return this.fail("goes beyond its chunk");
    const header = unitAt(words, unit);
    const mode = header & 3;
    const predictor = (header >> 2) & 3;
    const extra = unit + 1;
    const runs = mode >= modeRuns;
    const first = extra + (runs ? 3 : 0) + (mode === modeBase ? (predictor === none ? 6 : 2) : 0);
    if (first > end) return this.fail("goes beyond its chunk");
    const { width } = this;
    let sum = 0; // of the widths
    for (let axis = 0; axis < 3; axis++) {
      const code = (header >> (4 + 4 * axis)) & 15;
      const selectors = runs ? unitAt(words, extra + axis) : 0;
      for (let run = 0; run < 8; run++) {
        const wide = narrowed[4 * code + ((selectors >> (2 * run)) & 3)] as number;
        width[8 * axis + run] = wide;
        sum += wide;
      }
    }
    this.readBase(words, extra + 3, mode, predictor);
    const bits = mode === modeMask ? this.readMasked(words, extra, end) : this.readRuns(words, 16 * first, 8 * sum, end);
    if (bits < 0) return this.fail("goes beyond its chunk");
    const wrong = faultOf(mode, predictor, keyframe, velocities);
    if (wrong) return this.fail(wrong);
    predict(predictor, this.values, this.base, newest, before, at);
    return (bits + 15) >>> 4;
  }

  private fail(fault: string): number {
    this.fault = fault;
    return -1;
  }

  private readBase(words: Uint32Array, unit: number, mode: number, predictor: number): void {
    if (mode !== modeBase) {
      this.base.fill(0);
    } else if (predictor === none) {
      for (let axis = 0; axis < 3; axis++) this.base[axis] = wordAt(words, unit + 2 * axis);
    } else {
      const bits = wordAt(words, unit);
      for (let axis = 0; axis < 3; axis++) {
        this.base[axis] = ((bits << (22 - 10 * axis)) >> 22) << (2 * (bits >>> 30));
      }
    }
  }

  /** Values of all spheres, `bits` in all, from `bit` on. Gives the bit behind them, or -1. */
  private readRuns(words: Uint32Array, bit: number, bits: number, end: number): number {
    const { width, values } = this;
    if (bit + bits > 16 * end) return -1;
    for (let run = 0; run < 24; run++) {
      const wide = width[run] as number;
      readRun(words, bit, wide, values, 8 * run);
      bit += 8 * wide;
    }
    return bit;
  }

  /** Masks and values from `unit` on. Gives the bit behind them, or -1. */
  private readMasked(words: Uint32Array, unit: number, end: number): number {
    const { width, changed, values } = this;
    let byte = 2 * unit + 3;
    if (byte > 2 * end) return -1;
    for (let run = 0; run < 24; run++) {
      changed[run] = 0;
      if (!((byteAt(words, 2 * unit + (run >> 3)) >> (run & 7)) & 1)) continue;
      if (byte >= 2 * end) return -1;
      changed[run] = byteAt(words, byte++);
    }
    let bit = 8 * byte;
    let sum = 0;
    for (let run = 0; run < 24; run++) sum += (width[run] as number) * (bitCount[changed[run] as number] as number);
    if (bit + sum > 16 * end) return -1;
    for (let run = 0; run < 24; run++) {
      const which = changed[run] as number;
      const wide = width[run] as number;
      if (which === 0) {
        values.fill(0, 8 * run, 8 * run + 8);
        continue;
      }
      readChanged(words, bit, wide, which, values, 8 * run);
      bit += wide * (bitCount[which] as number);
    }
    return bit;
  }
}

function unitAt(words: Uint32Array, unit: number): number {
  return ((words[unit >>> 1] as number) >>> (16 * (unit & 1))) & 0xffff;
}

function byteAt(words: Uint32Array, byte: number): number {
  return ((words[byte >>> 2] as number) >>> (8 * (byte & 3))) & 0xff;
}

function wordAt(words: Uint32Array, unit: number): number {
  return unitAt(words, unit) | (unitAt(words, unit + 1) << 16);
}

/** What is wrong with such a block, apart from its size. */
function faultOf(mode: number, predictor: number, keyframe: boolean, velocities: boolean): string {
  if ((predictor === none) !== keyframe) return keyframe ? "is predicted in a keyframe" : "is not predicted in a delta frame";
  if (keyframe) return mode === modeBase ? "" : "has no base";
  return predictor === previous || velocities ? "" : "is predicted from a velocity right after a keyframe";
}
