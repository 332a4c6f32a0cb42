import { BlockReader } from "./block";
import { blockSpheres, chunkBlocks, groupBlocks, headWords } from "./format";
import { hashOf } from "./hash";
import { headOf } from "./head";
import type { FrameHead } from "./head";

/**
 * The decoder of docs/codec.md: one chain of frames. What it is given may be hostile. It allocates for its spheres, and for
 * the longest frame that it was given; nothing per frame.
 */
export class Decoder {
  /** On the grid, x y z, in the codec's order; whole blocks. The other array holds those of the frame before. */
  newest: Int32Array;
  before: Int32Array;
  private words = new Uint32Array(0); // of the frame, and two more
  private view = new DataView(this.words.buffer); // the same
  private number = 0;
  private history = 0; // states that are known, at most 2
  private readonly blocks: number;
  private readonly reader = new BlockReader();

  /** `spheres`: at least 1. */
  constructor(readonly spheres: number) {
    this.blocks = Math.ceil(spheres / blockSpheres);
    this.newest = new Int32Array(3 * blockSpheres * this.blocks);
    this.before = new Int32Array(this.newest.length);
  }

  /** No delta frame can be taken: none was there yet, or something went wrong. */
  get wantsKeyframe(): boolean {
    return this.history === 0;
  }

  /**
   * Takes the next frame. Throws an Error that says what is wrong and where for one that is malformed, of other spheres, or
   * does not follow the frame before; then it wants a keyframe, and keeps the positions it had (after a hash that differs:
   * those of the frame).
   */
  apply(frame: Uint8Array): FrameHead {
    const history = this.history;
    this.history = 0;
    const length = this.take(frame);
    const head = headOf(this.words, frame.byteLength);
    this.checkOrder(head, history);
    if (frame.byteLength % 4 !== 0) throw new Error("frame, end: is no whole word");
    this.decode(head, length, history);
    [this.newest, this.before] = [this.before, this.newest];
    this.number = head.number;
    if (head.hash !== undefined && head.hash !== hashOf(this.newest, this.spheres)) {
      throw new Error("frame, head: has another hash than its positions");
    }
    this.history = head.keyframe ? 1 : 2;
    return head;
  }

  /** The frame's words, aligned, with two more behind them. */
  private take(frame: Uint8Array): number {
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
    if (history === 0) throw new Error("frame, head: is no keyframe, and none came before");
    if (head.number !== (this.number + 1) >>> 0) {
      throw new Error(`frame, head: is number ${head.number}, which does not follow ${this.number}`);
    }
  }

  private decode(head: FrameHead, length: number, history: number): void {
    const chunks = Math.ceil(this.blocks / chunkBlocks);
    const start = headWords + chunks;
    if (length < start) throw new Error("frame, table: goes beyond the end");
    let begin = start;
    for (let chunk = 0; chunk < chunks; chunk++) {
      const end = start + (this.words[headWords + chunk] as number);
      if (end < begin || end > length) throw new Error(`frame, chunk ${chunk}: ends outside of the frame`);
      this.decodeChunk(head.keyframe, history === 2, chunk, begin, end);
      begin = end;
    }
    if (begin !== length) throw new Error("frame, end: is not that of the last chunk");
  }

  private decodeChunk(keyframe: boolean, velocities: boolean, chunk: number, begin: number, end: number): void {
    const { words, view, newest, before, reader } = this;
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
          unit = reader.read(view, unit, 2 * end, keyframe, velocities, newest, before, at);
          if (unit < 0) throw new Error(`frame, block ${first + k}: ${reader.fault}`);
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
