import { Quantity } from "./gen/spherule/v1/frame_pb";
import type { Frame } from "./gen/spherule/v1/frame_pb";
import type { Turns } from "./codec/turns";

/** The per-sphere values that frames carry. Each column is a chain of codec SPB with its own quantum. */

/** The values of all spheres in one state. */
export interface Column {
  values: Float32Array; // `components` per sphere, by place
  quantum: number; // unit of the quantity or of the angular velocities
  quantity?: Quantity | undefined; // that the values are; undefined: orientations
}

/**
 * The positions of all spheres in one state, as the codec's whole numbers. model/units.ts makes metres of them for
 * the page, and renderer/shaders/spheres.glsl for the image.
 */
export interface Positions {
  values: Int32Array; // x y z (quanta, relative to the centre of the bounds) per sphere, by place
  quantum: number; // m: a position is off by at most half of it
  quanta: Quanta;
  turns: Turns; // values in the length of each periodic axis; 0: the axis is not periodic, or values do not repeat
}

/** m per unit of each axis. A periodic axis has its own: its length is a whole number of them. */
export type Quanta = [number, number, number];

export interface EncodedColumn {
  quantum: number;
  spb: Uint8Array;
  quantity?: Quantity | undefined;
}

interface ColumnFormat {
  components: number; // values per sphere, at most 3
  whole?: true; // values are whole numbers, else floats
  /** Undefined: the frame does not have the column. */
  encoded(frame: Frame): EncodedColumn | undefined;
}

/** A column of this name has tables in the shaders: u_<name>From and u_<name>To (renderer/program.ts). */
export const columnFormats: { position: ColumnFormat; value: ColumnFormat; turn: ColumnFormat } = {
  position: { components: 3, whole: true, encoded: ({ quantum, spb }) => ({ quantum, spb }) },
  // a quantity; within 1 %
  value: {
    components: 1,
    encoded: ({ quantity, unit, values }) =>
      quantity === Quantity.QUANTITY_UNSPECIFIED ? undefined : { quantum: unit, spb: values, quantity },
  },
  // orientations as of Orientations, integrated from the angular velocities of frames
  turn: {
    components: 3,
    encoded: ({ spinUnit, spins }) => (spinUnit === 0 ? undefined : { quantum: spinUnit, spb: spins }),
  },
};

export type ColumnName = keyof typeof columnFormats;

/** The columns of one state. They share one buffer, one after another. */
export type Columns = { position: Positions; value?: Column; turn?: Column };

export const columnNames = Object.keys(columnFormats) as ColumnName[];

export function bufferOf(columns: Columns): ArrayBuffer {
  return columns.position.values.buffer as ArrayBuffer;
}

/** Spheres per block: neighbours in the codec's order. A state has the box of the positions in each block. */
export const blockPlaces = 512;
