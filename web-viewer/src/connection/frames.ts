import { Decoder } from "../codec/decoder";
import { isKeyframe } from "../codec/head";
import type { Frame, Order } from "../gen/spherule/v1/frame_pb";
import type { Buffers } from "./buffers";
import { placesOf } from "./order";
import { scatter } from "./scatter";

/** What a frame gave: positions; nothing, as it is of spheres or an order that are not these; or the chain is lost. */
export type Decoded = { kind: "state"; positions: Float32Array } | { kind: "foreign" } | { kind: "behind" };

/** Decodes frames to metres in id order, relative to the centre of the bounds. One chain at a time: a keyframe begins it. */
export class Frames {
  private epoch: number | undefined;
  private count = 0;
  private order: number | undefined;
  private places: Uint32Array = new Uint32Array(0);
  private decoder: Decoder | undefined;
  private chain: string | undefined; // undefined: lost, or none has begun

  constructor(private readonly buffers: Buffers) {}

  /** Another connection: what was known holds no longer. */
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

  /** Takes the order that the next frames are in; throws an Error where it is none for these spheres. */
  setOrder(order: Order): void {
    if (order.epoch !== this.epoch) return;
    this.order = undefined;
    this.places = placesOf(order.ids, this.count);
    this.order = order.number;
  }

  /** Throws an Error that says what is wrong with a frame; then the chain is lost. */
  decode(frame: Frame): Decoded {
    if (frame.epoch !== this.epoch || frame.order !== this.order) return { kind: "foreign" };
    const chain = `${frame.epoch} ${frame.order} ${frame.tier} ${frame.quantum}`;
    if (chain !== this.chain && !isKeyframe(frame.spb)) {
      this.chain = undefined;
      return { kind: "behind" };
    }
    this.chain = undefined;
    if (frame.count !== this.count) throw new Error(`frame ${frame.sequence}: ${frame.count} spheres, of ${this.count}`);
    if (!(frame.quantum > 0 && frame.quantum < Infinity)) throw new Error(`frame ${frame.sequence}: has no quantum`);
    if (this.decoder?.spheres !== this.count) this.decoder = new Decoder(this.count);
    this.decoder.apply(frame.spb);
    this.chain = chain;
    const positions = new Float32Array(this.buffers.take(12 * this.count), 0, 3 * this.count);
    scatter(this.decoder.newest, this.places, frame.quantum, positions);
    return { kind: "state", positions };
  }
}
