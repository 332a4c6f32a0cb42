import { Quantity } from "./gen/spherule/v1/frame_pb";
import type { Frame } from "./gen/spherule/v1/frame_pb";

/** The per-sphere values that frames carry. Each column is a chain of codec SPB with its own quantum. */

/** The values of all spheres in one state. */
export interface Column {
  values: Float32Array; // `components` per sphere, by place
  quantum: number; // a position is off by at most half of it; for speeds: their unit
}

export interface EncodedColumn {
  quantum: number;
  spb: Uint8Array;
}

interface ColumnFormat {
  components: number; // values per sphere, at most 3
  /** Undefined: the frame does not have the column. */
  encoded(frame: Frame): EncodedColumn | undefined;
}

/** A column of this name is an input of the shaders: a_<name>From and a_<name>To (renderer/program.ts). */
export const columnFormats: { position: ColumnFormat; speed: ColumnFormat } = {
  // x y z (m), relative to the centre of the bounds
  position: { components: 3, encoded: (frame) => frame },
  // m/s; within 1 %
  speed: {
    components: 1,
    encoded: ({ quantity, unit, values }) =>
      quantity === Quantity.SPEED ? { quantum: unit, spb: values } : undefined,
  },
};

export type ColumnName = keyof typeof columnFormats;

/** The columns of one state. They share one buffer, one after another. */
export type Columns = { position: Column } & Partial<Record<ColumnName, Column>>;

/** The columns of a state that is not shown. */
export const noColumns: Columns = { position: { values: new Float32Array(0), quantum: 0 } };

export const columnNames = Object.keys(columnFormats) as ColumnName[];

export function bufferOf(columns: Columns): ArrayBuffer {
  return columns.position.values.buffer as ArrayBuffer;
}

/** The values of all columns. */
export function valuesOf(columns: Columns): Float32Array {
  const length = columnNames.reduce((sum, name) => sum + (columns[name]?.values.length ?? 0), 0);
  return new Float32Array(bufferOf(columns), 0, length);
}
