import { modeBase, modeMask, modeRuns, none, previous, widths } from "./format";
import { move } from "./move";
import { bitCount, moveChanged } from "./values";

/** Bits of the values of a run, by its axis's width code and its selector. */
const narrowed = Uint8Array.from({ length: 64 }, (_, k) => widths[Math.max(0, (k >> 2) - (k & 3))] as number);

const noWidths = new Uint8Array(24);

/** Reads blocks, one after another; nothing is allocated per block. */
export class BlockReader {
  private readonly width = new Uint8Array(24); // bits, by axis and run
  private readonly changed = new Uint8Array(24); // mode mask: bit per value
  private readonly base = new Int32Array(3);
  /** What is wrong with the block, where `read` gave -1. */
  fault = "";

  /**
   * The block at `unit` (16 bits): its new positions go into `before` at `at`. Gives the unit behind it, or -1 where it
   * goes beyond the unit `end` or breaks the rules of keyframes. `view` has eight bytes behind `end`.
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

  /** Selectors are at the unit `selected`, or all 0 where it is -1. Gives the sum. */
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

  /** Masks from `unit` on. Gives the bit behind the values that follow them, or -1 where there is no room for them. */
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

  /** The values that end before the bit `behind`, from the last run on: so it need not be kept where they begin. */
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

/** What is wrong with such a block, apart from its size. */
function faultOf(mode: number, predictor: number, keyframe: boolean, velocities: boolean): string {
  if ((predictor === none) !== keyframe) return keyframe ? "is predicted in a keyframe" : "is not predicted in a delta frame";
  if (keyframe) return mode === modeBase ? "" : "has no base";
  return predictor === previous || velocities ? "" : "is predicted from a velocity right after a keyframe";
}
