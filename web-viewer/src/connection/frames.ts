import { Decoder } from "../codec/decoder";
import { isKeyframe } from "../codec/head";
import { speedsOf } from "../codec/speeds";
import { blockPlaces, columnFormats, columnNames } from "../columns";
import type { ColumnName, Columns, EncodedColumn } from "../columns";
import type { Frame, Order } from "../gen/spherule/v1/frame_pb";
import type { BufferPool } from "./buffer_pool";
import type { DrawOrder, State } from "./messages";
import { boxesOf, idsOf, scatter } from "./order";
import type { Quanta } from "./order";
import type { Periods } from "./periods";

/**
 * The result of decoding a frame. `state`: its columns. `foreign`: the frame is of another epoch or order, and is
 * ignored. `behind`: the chain is lost, and decoding needs a keyframe.
 */
export type Decoded = ({ kind: "state" } & DecodedState) | { kind: "foreign" } | { kind: "behind" };

export type DecodedState = Pick<State, "columns" | "order" | "boxes">;

/**
 * Decodes frames to columns, by place. Decodes one chain at a time; a keyframe starts a chain. A frame is a keyframe
 * if all its columns are.
 */
export class Frames {
  private epoch: number | undefined;
  private count = 0;
  private periods: Periods = [0, 0, 0];
  private order: number | undefined;
  private ids: Uint32Array = new Uint32Array(0);
  private readonly decoders = new Map<ColumnName, Decoder>();
  private chain: string | undefined; // undefined: lost, or not yet started

  constructor(private readonly buffers: BufferPool) {}

  /** Forgets epoch, order and chain: a new connection has been made. */
  reset(): void {
    this.epoch = undefined;
    this.order = undefined;
    this.chain = undefined;
  }

  setScene(epoch: number, count: number, periods: Periods = [0, 0, 0]): void {
    this.periods = periods;
    if (epoch === this.epoch && count === this.count) return;
    this.epoch = epoch;
    this.count = count;
    this.order = undefined;
    this.chain = undefined;
  }

  /**
   * Sets the order of the next frames; returns a copy. Undefined: it is of another epoch. Throws an Error if the order
   * is no permutation of the scene's ids.
   */
  setOrder(order: Order): DrawOrder | undefined {
    if (order.epoch !== this.epoch) return undefined;
    this.order = undefined;
    this.ids = idsOf(order.ids, this.count);
    this.order = order.number;
    return { epoch: order.epoch, number: order.number, places: this.ids.slice() };
  }

  /** Throws an Error that says what is wrong with a malformed frame; the chain is then lost. */
  decode(frame: Frame): Decoded {
    if (frame.epoch !== this.epoch || frame.order !== this.order) return { kind: "foreign" };
    const encoded = encodedColumns(frame);
    const grids = encoded.map(({ name, quantum }) => `${name} ${quantum}`);
    const chain = [frame.epoch, frame.order, frame.tier, ...grids].join(" ");
    if (chain !== this.chain && !encoded.every(({ spb }) => isKeyframe(spb))) {
      this.chain = undefined;
      return { kind: "behind" };
    }
    this.chain = undefined;
    if (frame.count !== this.count) {
      throw new Error(`frame ${frame.sequence}: has ${frame.count} spheres, expected ${this.count}`);
    }
    if (!encoded.every(({ quantum }) => quantum > 0 && quantum < Infinity)) {
      throw new Error(`frame ${frame.sequence}: has no quantum`);
    }
    for (const { name, spb } of encoded) this.decoderOf(name).apply(spb);
    this.chain = chain;
    return { kind: "state", ...this.stateOf(encoded, frame.order) };
  }

  private decoderOf(name: ColumnName): Decoder {
    let decoder = this.decoders.get(name);
    if (decoder?.spheres !== this.count) {
      decoder = new Decoder(this.count);
      this.decoders.set(name, decoder);
    }
    return decoder;
  }

  /** The quantum of each axis: a periodic one has its own, of which a whole number fits its length. */
  private quantaOf({ turns }: Decoder, quantum: number): Quanta {
    return turns.map((each, axis) => (each > 0 ? (this.periods[axis] as number) / each : quantum)) as Quanta;
  }

  /** The state of the frame that has just been decoded. */
  private stateOf(encoded: NamedColumn[], order: number): DecodedState {
    const valuesPerSphere = encoded.reduce((sum, { name }) => sum + columnFormats[name].components, 0);
    const boxFloats = 6 * Math.ceil(this.count / blockPlaces);
    const floats = valuesPerSphere * this.count + boxFloats;
    const buffer = this.buffers.acquire(Float32Array.BYTES_PER_ELEMENT * floats);
    let at = 0;
    const filled = encoded.map(({ name, quantum }) => {
      const { components } = columnFormats[name];
      const values = new Float32Array(buffer, at, components * this.count);
      const decoder = this.decoderOf(name);
      if (name === "speed") speedsOf(decoder.newest, this.ids, quantum, values);
      else scatter(decoder.newest, this.ids, components, this.quantaOf(decoder, quantum), values);
      at += values.byteLength;
      return [name, { values, quantum }];
    });
    const positions = this.decoderOf("position");
    const boxes = new Float32Array(buffer, at, boxFloats);
    boxesOf(positions.newest, this.count, this.quantaOf(positions, encoded[0]?.quantum ?? 0), this.periods, boxes);
    return { columns: Object.fromEntries(filled) as Columns, order, boxes };
  }
}

type NamedColumn = EncodedColumn & { name: ColumnName };

/** The columns that a frame has. */
function encodedColumns(frame: Frame): NamedColumn[] {
  return columnNames.flatMap((name) => {
    const encoded = columnFormats[name].encoded(frame);
    return encoded ? [{ name, quantum: encoded.quantum, spb: encoded.spb }] : [];
  });
}
