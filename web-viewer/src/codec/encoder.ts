import { BitWriter } from "./bit_writer";
import { blockSpheres, chunkBlocks, groupBlocks, hashedFlag, headWords, keyframeFlag, magic } from "./format";
import { linear, modeBase, modeRuns, none, previous, turnsFlag, turnsHeadWords, widths } from "./format";
import { hashOf } from "./hash";
import { nearest, noTurns, sameTurns } from "./turns";
import type { Turns } from "./turns";

const axes = 3;
const blockValues = axes * blockSpheres;
const runSpheres = 8;
const runs = blockSpheres / runSpheres;
const longestBlock = 24 + 4 * blockValues; // bytes

/** The smallest code whose width has room for this many bits. */
const codeOf = Uint8Array.from({ length: 33 }, (_, bits) => widths.findIndex((width) => width >= bits));

/**
 * Encodes one chain of frames, after docs/codec.md. It uses two of the format's modes and the better of two predictors,
 * so its frames are longer than the server's.
 */
export class Encoder {
  private now: Int32Array; // x y z per sphere, filled up to whole blocks
  private last: Int32Array; // the frame before
  private older: Int32Array; // the frame before that
  private turns = noTurns;
  private number = 0;
  private known = 0; // states before this one that a decoder has, at most 2
  private readonly blocks: number;
  private readonly steps = new Int32Array(blockValues); // values of a block, by axis and sphere
  private readonly changes = new Int32Array(blockValues);
  private readonly writer = new BitWriter();

  constructor(private readonly spheres: number) {
    this.blocks = Math.ceil(spheres / blockSpheres);
    this.now = new Int32Array(blockValues * this.blocks);
    this.last = this.now.slice();
    this.older = this.now.slice();
  }

  /** The next frame. `positions`: x y z of each sphere, in grid units. A frame of other turns is a keyframe. */
  encode(positions: Int32Array, turns: Turns, hashed: boolean): { spb: Uint8Array<ArrayBuffer>; keyframe: boolean } {
    if (!sameTurns(turns, this.turns)) this.known = 0;
    this.turns = turns;
    this.number += 1;
    [this.now, this.last, this.older] = [this.older, this.now, this.last];
    const { now, spheres } = this;
    now.set(positions.subarray(0, axes * spheres));
    for (let at = axes * spheres; at < now.length; at++) now[at] = now[at - axes] as number;
    const keyframe = this.known === 0;
    const spb = this.frame(keyframe, hashed);
    this.known = keyframe ? 1 : 2;
    return { spb, keyframe };
  }

  /** The newest frame once more, as a keyframe, at which decoding can begin. */
  resync(): Uint8Array<ArrayBuffer> {
    this.known = 1;
    return this.frame(true, true);
  }

  private frame(keyframe: boolean, hashed: boolean): Uint8Array<ArrayBuffer> {
    const { writer, turns, blocks, spheres } = this;
    const counts = turns.some((each) => each > 0);
    const chunks = Math.ceil(blocks / chunkBlocks);
    writer.clear();
    writer.reserve(4 * (turnsHeadWords + chunks));
    const flags = (keyframe ? keyframeFlag : 0) | (hashed ? hashedFlag : 0) | (counts ? turnsFlag : 0);
    const head = [magic | flags, spheres, this.number, hashed ? hashOf(this.now, spheres) : 0];
    for (const word of counts ? [...head, ...turns] : head) writer.word(word);
    const table = 4 * (counts ? turnsHeadWords : headWords);
    const start = table + 4 * chunks;
    writer.end = start;
    for (let first = 0; first < blocks; first += groupBlocks) {
      this.writeGroup(keyframe, first, Math.min(groupBlocks, blocks - first));
      writer.setWord(table + 4 * Math.floor(first / chunkBlocks), (writer.end - start) / 4);
    }
    return writer.written();
  }

  private writeGroup(keyframe: boolean, first: number, count: number): void {
    const { writer } = this;
    writer.reserve(4 + longestBlock * count);
    const at = writer.end;
    writer.end += 4;
    let present = 0;
    for (let k = 0; k < count; k++) {
      const block = blockValues * (first + k);
      if (keyframe ? this.writePlaces(block) : this.writeSteps(block)) present |= 1 << k;
    }
    writer.setWord(at, present);
    writer.align(4);
  }

  /** Writes a block of a keyframe. `at`: its first value. */
  private writePlaces(at: number): boolean {
    const { now, steps } = this;
    const base = [0, 1, 2].map((axis) => {
      let [low, high] = [Infinity, -Infinity];
      for (let k = at + axis; k < at + blockValues; k += axes) {
        low = Math.min(low, now[k] as number);
        high = Math.max(high, now[k] as number);
      }
      return Math.floor((low + high) / 2);
    });
    for (let axis = 0, to = 0; axis < axes; axis++) {
      for (let k = at + axis; k < at + blockValues; k += axes) {
        steps[to++] = zigzag((now[k] as number) - (base[axis] as number));
      }
    }
    this.writeValues(modeBase | (none << 2), steps, base);
    return true;
  }

  /** Writes a block of a delta frame. Returns false, and writes nothing, if its spheres have not moved. */
  private writeSteps(at: number): boolean {
    const bits = this.predict(at, false, this.steps);
    if (bits === 0) return false;
    const better = this.known === 2 && this.predict(at, true, this.changes) < bits;
    this.writeValues(modeRuns | ((better ? linear : previous) << 2), better ? this.changes : this.steps, []);
    return true;
  }

  /** Writes what the predictor leaves to `values`. Returns the sum of the largest bits of the axes. */
  private predict(at: number, linearly: boolean, values: Int32Array): number {
    const { now, last, older } = this;
    let bits = 0;
    for (let axis = 0, to = 0; axis < axes; axis++) {
      const turns = this.turns[axis] as number;
      let all = 0;
      for (let k = at + axis; k < at + blockValues; k += axes) {
        const place = last[k] as number;
        let rest = near((now[k] as number) - place, turns);
        if (linearly) rest = near(rest - near(place - (older[k] as number), turns), turns);
        const value = zigzag(rest);
        values[to++] = value;
        all |= value;
      }
      bits += bitsOf(all);
    }
    return bits;
  }

  /** `mode`: with the predictor, as in the header. */
  private writeValues(mode: number, values: Int32Array, base: number[]): void {
    const { writer } = this;
    let header = mode;
    const selectors = [0, 0, 0];
    const wide = new Uint8Array(axes * runs); // bits per value of each run
    for (let axis = 0; axis < axes; axis++) {
      const bits = Array.from({ length: runs }, (_, run) => bitsOfRun(values, blockSpheres * axis + runSpheres * run));
      const code = codeOf[Math.max(...bits)] as number;
      header |= code << (4 + 4 * axis);
      bits.forEach((needed, run) => {
        const narrow = Math.min(3, code - (codeOf[needed] as number));
        selectors[axis] = (selectors[axis] as number) | (narrow << (2 * run));
        wide[runs * axis + run] = widths[code - narrow] as number;
      });
    }
    writer.unit(header);
    for (const selector of selectors) writer.unit(selector);
    for (const each of base) writer.word(each);
    for (let k = 0; k < blockValues; k++) writer.field(values[k] as number, wide[Math.floor(k / runSpheres)] as number);
    writer.align(2);
  }
}

/** 0, -1, 1, -2 as 0, 1, 2, 3. */
function zigzag(value: number): number {
  return (value << 1) ^ (value >> 31);
}

/** The steps's image that is nearest to 0, if the axis has turns. */
function near(step: number, turns: number): number {
  return turns > 0 ? nearest(step | 0, turns) : step | 0;
}

function bitsOf(value: number): number {
  return 32 - Math.clz32(value);
}

function bitsOfRun(values: Int32Array, first: number): number {
  let all = 0;
  for (let k = first; k < first + runSpheres; k++) all |= values[k] as number;
  return bitsOf(all);
}
