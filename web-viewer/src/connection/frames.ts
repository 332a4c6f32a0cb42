import { Decoder } from "../codec/decoder";
import { isKeyframe } from "../codec/head";
import type { Frame, Order } from "../gen/spherule/v1/frame_pb";
import type { BufferPool } from "./buffer_pool";
import { positionOffsets, scatter } from "./order";

/**
 * The result of decoding a frame. `state`: its positions. `foreign`: the frame is of another epoch or order, and is
 * ignored. `behind`: the chain is lost, and decoding needs a keyframe.
 */
export type Decoded = { kind: "state"; positions: Float32Array } | { kind: "foreign" } | { kind: "behind" };

/**
 * Decodes frames to positions (m) in id order, relative to the centre of the bounds. Decodes one chain at a time; a
 * keyframe starts a chain.
 */
export class Frames {
  private epoch: number | undefined;
  private count = 0;
  private order: number | undefined;
  private offsets: Uint32Array = new Uint32Array(0);
  private decoder: Decoder | undefined;
  private chain: string | undefined; // undefined: lost, or not yet started

  constructor(private readonly buffers: BufferPool) {}

  /** Forgets epoch, order and chain: a new connection has been made. */
  reset(): void {
    this.epoch = undefined;
    this.order = undefined;
    this.chain = undefined;
  }

  setScene(epoch: number, count: number): void {
    if (epoch === this.epoch && count === this.count) return;
    this.epoch = epoch;
    this.count = count;
    this.order = undefined;
    this.chain = undefined;
  }

  /** Sets the order of the next frames. Throws an Error if the order is no permutation of the scene's ids. */
  setOrder(order: Order): void {
    if (order.epoch !== this.epoch) return;
    this.order = undefined;
    this.offsets = positionOffsets(order.ids, this.count);
    this.order = order.number;
  }

  /** Throws an Error that says what is wrong with a malformed frame; the chain is then lost. */
  decode(frame: Frame): Decoded {
    if (frame.epoch !== this.epoch || frame.order !== this.order) return { kind: "foreign" };
    const chain = `${frame.epoch} ${frame.order} ${frame.tier} ${frame.quantum}`;
    if (chain !== this.chain && !isKeyframe(frame.spb)) {
      this.chain = undefined;
      return { kind: "behind" };
    }
    this.chain = undefined;
    if (frame.count !== this.count) {
      throw new Error(`frame ${frame.sequence}: has ${frame.count} spheres, expected ${this.count}`);
    }
    if (!(frame.quantum > 0 && frame.quantum < Infinity)) throw new Error(`frame ${frame.sequence}: has no quantum`);
    if (this.decoder?.spheres !== this.count) this.decoder = new Decoder(this.count);
    this.decoder.apply(frame.spb);
    this.chain = chain;
    const positions = new Float32Array(this.buffers.acquire(12 * this.count), 0, 3 * this.count);
    scatter(this.decoder.newest, this.offsets, frame.quantum, positions);
    return { kind: "state", positions };
  }
}
