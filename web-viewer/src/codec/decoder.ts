import { BlockReader } from "./block";
import { blockSpheres, chunkBlocks, groupBlocks } from "./format";
import { hashOf } from "./hash";
import { headOf } from "./head";
import type { FrameHead } from "./head";
import { moveBack, noTurns, sameTurns, shortenSteps } from "./turns";
import type { Turns } from "./turns";

/** A moment of a chain: a decoder that has it can decode the next frame. */
export interface ChainState {
  newest: Int32Array;
  before: Int32Array;
  turns: Turns;
  number: number; // of the newest frame
  history: number; // known states, at most 2
}

/**
 * Decodes one chain of frames, after docs/codec.md. Frames may be hostile. The decoder allocates memory for its spheres
 * and for the longest frame so far, and none per frame.
 */
export class Decoder {
  /**
   * Positions in grid units, x y z, in the codec's order, filled up to whole blocks. `before`: positions of the
   * previous frame.
   */
  newest: Int32Array;
  before: Int32Array;
  /** The turns of the newest frame. */
  turns: Turns = noTurns;
  private words = new Uint32Array(0); // the frame, and two more words
  private view = new DataView(this.words.buffer); // the same bytes
  private number = 0; // of the newest frame
  private history = 0; // known states, at most 2
  private readonly blocks: number;
  private readonly reader = new BlockReader();

  /** `spheres` must be at least 1. */
  constructor(readonly spheres: number) {
    this.blocks = Math.ceil(spheres / blockSpheres);
    this.newest = new Int32Array(3 * blockSpheres * this.blocks);
    this.before = new Int32Array(this.newest.length);
  }

  /** Whether the next frame must be a keyframe: there was none yet, or the last frame was refused. */
  get wantsKeyframe(): boolean {
    return this.history === 0;
  }

  /** Returns a copy of the present state. */
  save(): ChainState {
    const { newest, before, turns, number, history } = this;
    return { newest: newest.slice(), before: before.slice(), turns, number, history };
  }

  /** Continues from a saved state of a decoder of as many spheres. */
  restore({ newest, before, turns, number, history }: ChainState): void {
    this.newest.set(newest);
    this.before.set(before);
    this.turns = turns;
    this.number = number;
    this.history = history;
  }

  /**
   * Decodes the next frame. Throws an Error, which says what is wrong and where, if the frame is malformed, has another
   * number of spheres, or does not follow the previous frame. The next frame must then be a keyframe. The positions are
   * unchanged after an Error, except if the hash differs: then they are the new ones.
   */
  apply(frame: Uint8Array): FrameHead {
    const history = this.history;
    this.history = 0;
    const length = this.copy(frame);
    const head = headOf(this.words, frame.byteLength);
    this.checkOrder(head, history);
    if (frame.byteLength % 4 !== 0) throw new Error("frame, end: is no whole word");
    this.decode(head, length, history);
    [this.newest, this.before] = [this.before, this.newest];
    this.number = head.number;
    this.turns = head.turns;
    if (head.hash !== undefined && head.hash !== hashOf(this.newest, this.spheres)) {
      throw new Error("frame, head: has another hash than its positions");
    }
    this.history = head.keyframe ? 1 : 2;
    return head;
  }

  /** Copies the frame to aligned words; returns their number. */
  private copy(frame: Uint8Array): number {
    const length = frame.byteLength >>> 2;
    if (this.words.length < length + 2) {
      this.words = new Uint32Array(length + (length >>> 3) + 2);
      this.view = new DataView(this.words.buffer);
    }
    new Uint8Array(this.words.buffer).set(frame.subarray(0, 4 * length));
    return length;
  }

  private checkOrder(head: FrameHead, history: number): void {
    if (head.spheres !== this.spheres) {
      throw new Error(`frame, head: has ${head.spheres} spheres where there are ${this.spheres}`);
    }
    if (head.keyframe) return;
    if (history !== 0 && !sameTurns(head.turns, this.turns)) {
      throw new Error("frame, head: has other turns than the frame before");
    }
    if (history === 0) throw new Error("frame, head: is no keyframe, and none came before");
    if (head.number !== (this.number + 1) >>> 0) {
      throw new Error(`frame, head: is number ${head.number}, which does not follow ${this.number}`);
    }
  }

  private decode(head: FrameHead, length: number, history: number): void {
    const chunks = Math.ceil(this.blocks / chunkBlocks);
    const start = head.words + chunks;
    if (length < start) throw new Error("frame, table: goes beyond the end");
    let begin = start;
    for (let chunk = 0; chunk < chunks; chunk++) {
      const end = start + (this.words[head.words + chunk] as number);
      if (end < begin || end > length) throw new Error(`frame, chunk ${chunk}: ends outside of the frame`);
      this.decodeChunk(head, history === 2, chunk, begin, end);
      begin = end;
    }
    if (begin !== length) throw new Error("frame, end: differs from the end of the last chunk");
  }

  private decodeChunk(head: FrameHead, velocities: boolean, chunk: number, begin: number, end: number): void {
    const { words, view, newest, before, reader } = this;
    const { keyframe, turns } = head;
    const counts = turns !== noTurns;
    const last = Math.min(this.blocks, (chunk + 1) * chunkBlocks);
    let word = begin;
    for (let first = chunk * chunkBlocks; first < last; first += groupBlocks) {
      if (word >= end) throw new Error(`frame, group of block ${first}: goes beyond its chunk`);
      const bitmap = words[word] as number;
      const count = Math.min(groupBlocks, last - first);
      if (count < groupBlocks && bitmap >>> count !== 0) {
        throw new Error(`frame, group of block ${first}: has blocks that do not exist`);
      }
      let unit = 2 * (word + 1);
      for (let k = 0; k < count; k++) {
        const at = (first + k) * 3 * blockSpheres;
        if ((bitmap >>> k) & 1) {
          if (counts) shortenSteps(turns, newest, before, at);
          unit = reader.read(view, unit, 2 * end, keyframe, velocities, newest, before, at);
          if (unit < 0) throw new Error(`frame, block ${first + k}: ${reader.fault}`);
          if (counts) moveBack(turns, before, at);
        } else {
          if (keyframe) throw new Error(`frame, block ${first + k}: is missing in a keyframe`);
          before.set(newest.subarray(at, at + 3 * blockSpheres), at);
        }
      }
      word = (unit + 1) >>> 1;
    }
    if (word !== end) throw new Error(`frame, chunk ${chunk}: does not end where its groups do`);
  }
}
