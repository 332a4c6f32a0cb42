import { modeBase, modeMask, modeRuns, none, previous, widths } from "./format";
import { move } from "./move";
import { bitCount, moveChanged } from "./values";

/** Bits per value of a run, by the width code of its axis and by its selector: index 4 * code + selector. */
const narrowed = Uint8Array.from({ length: 64 }, (_, k) => widths[Math.max(0, (k >> 2) - (k & 3))] as number);

const noWidths = new Uint8Array(24);

/** Reads blocks one after another. It allocates nothing per block. */
export class BlockReader {
  private readonly width = new Uint8Array(24); // bits per value, by axis and run
  private readonly changed = new Uint8Array(24); // mode mask: one bit per value, by axis and run
  private readonly base = new Int32Array(3);
  /** Describes the fault of the block for which `read` returned -1. */
  fault = "";

  /**
   * Reads the block that begins at `unit`, and writes its new positions to `before`, starting at `at`. `unit` and `end`
   * count units of 16 bits. Returns the unit after the block, or -1 if the block extends beyond `end` or breaks the
   * rules of keyframes. `view` must have eight more bytes after `end`.
   */
  read(
    view: DataView,
    unit: number,
    end: number,
    keyframe: boolean,
    velocities: boolean,
    newest: Int32Array,
    before: Int32Array,
    at: number,
  ): number {
    if (unit >= end) return this.fail("goes beyond its chunk");
    const header = view.getUint16(2 * unit, true);
    const mode = header & 3;
    const predictor = (header >> 2) & 3;
    const extra = unit + 1;
    const runs = mode >= modeRuns;
    const first = extra + (runs ? 3 : 0) + (mode === modeBase ? (predictor === none ? 6 : 2) : 0);
    if (first > end) return this.fail("goes beyond its chunk");
    const sum = this.readWidths(view, header, runs ? extra : -1);
    this.readBase(view, extra + 3, mode, predictor);
    const behind = mode === modeMask ? this.readMasks(view, extra, end) : 16 * first + 8 * sum; // bits
    if (behind < 0 || behind > 16 * end) return this.fail("goes beyond its chunk");
    const wrong = faultOf(mode, predictor, keyframe, velocities);
    if (wrong) return this.fail(wrong);
    if (mode === modeMask) {
      move(predictor, view, 0, noWidths, this.base, newest, before, at);
      this.moveMasked(view, behind, before, at);
    } else {
      move(predictor, view, 2 * first, this.width, this.base, newest, before, at);
    }
    return (behind + 15) >>> 4;
  }

  private fail(fault: string): number {
    this.fault = fault;
    return -1;
  }

  /** Reads the width of each run; returns their sum. `selected`: unit of the selectors, or -1 if all are 0. */
  private readWidths(view: DataView, header: number, selected: number): number {
    const { width } = this;
    let sum = 0;
    for (let axis = 0; axis < 3; axis++) {
      const code = (header >> (4 + 4 * axis)) & 15;
      const selectors = selected < 0 ? 0 : view.getUint16(2 * (selected + axis), true);
      for (let run = 0; run < 8; run++) {
        const wide = narrowed[4 * code + ((selectors >> (2 * run)) & 3)] as number;
        width[8 * axis + run] = wide;
        sum += wide;
      }
    }
    return sum;
  }

  /** Reads the base at `unit`, which is 0 in modes without one. */
  private readBase(view: DataView, unit: number, mode: number, predictor: number): void {
    if (mode !== modeBase) {
      this.base.fill(0);
    } else if (predictor === none) {
      for (let axis = 0; axis < 3; axis++) this.base[axis] = view.getInt32(2 * unit + 4 * axis, true);
    } else {
      const bits = view.getInt32(2 * unit, true);
      for (let axis = 0; axis < 3; axis++) {
        this.base[axis] = ((bits << (22 - 10 * axis)) >> 22) << (2 * (bits >>> 30));
      }
    }
  }

  /**
   * Reads the masks at `unit`. Returns the bit after the values that follow them, or -1 if they extend beyond `end`.
   */
  private readMasks(view: DataView, unit: number, end: number): number {
    const { width, changed } = this;
    let byte = 2 * unit + 3;
    if (byte > 2 * end) return -1;
    let sum = 0;
    for (let run = 0; run < 24; run++) {
      changed[run] = 0;
      if (!((view.getUint8(2 * unit + (run >> 3)) >> (run & 7)) & 1)) continue;
      if (byte >= 2 * end) return -1;
      const which = view.getUint8(byte++);
      changed[run] = which;
      sum += (width[run] as number) * (bitCount[which] as number);
    }
    return 8 * byte + sum;
  }

  /** Moves the changed values, from the last run to the first. `behind`: the bit after the last value. */
  private moveMasked(view: DataView, behind: number, before: Int32Array, at: number): void {
    const { width, changed } = this;
    let bit = behind;
    for (let run = 23; run >= 0; run--) {
      const which = changed[run] as number;
      if (which === 0) continue;
      const wide = width[run] as number;
      bit -= wide * (bitCount[which] as number);
      moveChanged(view, bit, wide, which, before, at + (run >> 3) + 24 * (run & 7));
    }
  }
}

/** Says which rule of keyframes and delta frames the block breaks; empty if none. */
function faultOf(mode: number, predictor: number, keyframe: boolean, velocities: boolean): string {
  if ((predictor === none) !== keyframe) {
    return keyframe ? "is predicted in a keyframe" : "is not predicted in a delta frame";
  }
  if (keyframe) return mode === modeBase ? "" : "has no base";
  return predictor === previous || velocities ? "" : "is predicted from a velocity right after a keyframe";
}
