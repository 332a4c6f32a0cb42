import { Decoder } from "../codec/decoder";
import type { ChainState } from "../codec/decoder";
import { isKeyframe } from "../codec/head";
import { Orientations } from "../codec/orientations";
import { valuesOf } from "../codec/quantity_values";
import { noTurns } from "../codec/turns";
import type { Turns } from "../codec/turns";
import { blockPlaces, columnFormats, columnNames } from "../columns";
import type { Column, ColumnName, Columns, EncodedColumn, Positions, Quanta } from "../columns";
import type { Frame, Order } from "../gen/spherule/v1/frame_pb";
import type { BufferPool } from "./buffer_pool";
import type { DrawOrder, State } from "./messages";
import { boxesOf, idsOf, scatter } from "./order";
import type { Periods } from "./periods";

/** The values of a state. */
export type Content = Pick<State, "columns" | "order" | "boxes">;

/** The content of a state that is not shown. */
export const noContent: Content = {
  columns: { position: { values: new Int32Array(0), quantum: 0, quanta: [0, 0, 0], turns: noTurns } },
  order: -1,
  boxes: new Float64Array(0),
};

/**
 * The result of decoding a frame. `state`: its content. `foreign`: the frame is of another epoch or order, and is
 * ignored. `behind`: the chain is lost, and decoding needs a keyframe.
 */
export type Decoded = { kind: "state"; keyframe: boolean; content: Content } | { kind: "foreign" } | { kind: "behind" };

const bytesPerValue = 4;

/** The meaning of the numbers of a column. */
type Grid = Omit<NamedColumn, "spb">;

/** A moment of decoding, from which frames can be decoded later. Without `chain` the next frame is a keyframe. */
export interface FramesState {
  epoch: number;
  count: number; // places
  periods: Periods;
  order: number;
  ids: Uint32Array;
  chain?: { name: string; grids: Grid[]; states: [ColumnName, ChainState][] };
}

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
  private grids: Grid[] = []; // of the newest frame's columns
  private orientations: Orientations | undefined; // undefined: the newest frame has no angular velocities

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
    this.orientations = undefined;
    this.epoch = epoch;
    this.count = count;
    this.order = undefined;
    this.chain = undefined;
  }

  /** Sets the order of the next frames. Throws an Error if the order is no permutation of the scene's ids. */
  setOrder(order: Order): void {
    if (order.epoch !== this.epoch) return;
    this.order = undefined;
    this.ids = idsOf(order.ids, this.count);
    this.order = order.number;
  }

  /** The order of the newest frame. The array is another one for another order. */
  get drawOrder(): DrawOrder {
    return { epoch: this.epoch ?? -1, number: this.order ?? -1, places: this.ids };
  }

  /** The present state, as a copy. `chain`: false leaves out what only delta frames need. */
  save(chain: boolean): FramesState {
    const { epoch, count, periods, order, ids } = this;
    if (epoch === undefined || order === undefined) throw new Error("no scene or no order has come");
    const start: FramesState = { epoch, count, periods, order, ids };
    if (!chain || this.chain === undefined) return start;
    const states = this.grids.map(({ name }): [ColumnName, ChainState] => [name, this.decoderOf(name).save()]);
    return { ...start, chain: { name: this.chain, grids: this.grids, states } };
  }

  /** Continues from a saved state. */
  restore({ epoch, count, periods, order, ids, chain }: FramesState): void {
    Object.assign(this, { epoch, count, periods, order, ids, chain: chain?.name, grids: chain?.grids ?? [] });
    this.orientations = undefined;
    for (const [name, state] of chain?.states ?? []) this.decoderOf(name).restore(state);
  }

  /** The positions of the newest frame, in grid units and the codec's order. */
  get grid(): { newest: Int32Array; turns: Turns; quantum: number } {
    const { newest, turns } = this.decoderOf("position");
    return { newest, turns, quantum: this.grids.find(({ name }) => name === "position")?.quantum ?? NaN };
  }

  /** The content of the newest frame; undefined if the chain is lost. */
  get newest(): Content | undefined {
    return this.chain === undefined || this.order === undefined ? undefined : this.contentOf(this.order);
  }

  /**
   * Decodes a frame; `shown`: false leaves out the content. Throws an Error that says what is wrong with a malformed
   * frame; the chain is then lost.
   */
  decode(frame: Frame, shown = true): Decoded {
    if (frame.epoch !== this.epoch || frame.order !== this.order) return { kind: "foreign" };
    const encoded = encodedColumns(frame);
    const grids = encoded.map(({ name, quantum, quantity }) => `${name} ${quantity ?? ""} ${quantum}`);
    const chain = [frame.epoch, frame.order, frame.tier, ...grids].join(" ");
    const keyframe = encoded.every(({ spb }) => isKeyframe(spb));
    if (chain !== this.chain && !keyframe) {
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
    this.grids = encoded.map(({ name, quantum, quantity }) => ({ name, quantum, quantity }));
    this.turnSpheres(frame);
    return { kind: "state", keyframe, content: shown ? this.contentOf(frame.order) : noContent };
  }

  private turnSpheres({ spinUnit, simTime }: Frame): void {
    if (spinUnit === 0) {
      this.orientations = undefined;
      return;
    }
    this.orientations ??= new Orientations(this.count);
    this.orientations.turn(this.decoderOf("turn").newest, this.ids, spinUnit, simTime);
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

  /** The content of the newest frame. */
  private contentOf(order: number): Content {
    const valuesPerSphere = this.grids.reduce((sum, { name }) => sum + columnFormats[name].components, 0);
    const boxValues = 6 * Math.ceil(this.count / blockPlaces);
    const bytes = Float64Array.BYTES_PER_ELEMENT * boxValues + bytesPerValue * valuesPerSphere * this.count;
    const buffer = this.buffers.acquire(bytes);
    const boxes = new Float64Array(buffer, 0, boxValues);
    let at = boxes.byteLength;
    const filled = this.grids.map((grid) => {
      const column = this.columnOf(grid, buffer, at);
      at += column.values.byteLength;
      return [grid.name, column];
    });
    const columns = Object.fromEntries(filled) as Columns;
    boxesOf(this.decoderOf("position").newest, this.count, columns.position.quanta, this.periods, boxes);
    return { columns, order, boxes };
  }

  /** A column of the newest frame, with its values at a byte of a buffer. */
  private columnOf({ name, quantum, quantity }: Grid, buffer: ArrayBuffer, at: number): Column | Positions {
    const decoder = this.decoderOf(name);
    const length = columnFormats[name].components * this.count;
    if (name === "position") {
      const values = new Int32Array(buffer, at, length);
      scatter(decoder.newest, this.ids, values);
      return { values, quantum, quanta: this.quantaOf(decoder, quantum), turns: decoder.turns };
    }
    const values = new Float32Array(buffer, at, length);
    if (name === "value") valuesOf(decoder.newest, this.ids, quantum, values);
    else values.set(this.orientations?.values ?? []);
    return { values, quantum, quantity };
  }
}

type NamedColumn = EncodedColumn & { name: ColumnName };

/** The columns that a frame has. */
function encodedColumns(frame: Frame): NamedColumn[] {
  return columnNames.flatMap((name) => {
    const encoded = columnFormats[name].encoded(frame);
    return encoded ? [{ name, ...encoded }] : [];
  });
}
