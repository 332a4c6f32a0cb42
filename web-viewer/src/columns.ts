import type { Frame } from "./gen/spherule/v1/frame_pb";

/** The per-sphere values that frames carry. Each column is a chain of codec SPB with its own quantum. */

/** The values of all spheres in one state. */
export interface Column {
  values: Float32Array; // `components` per sphere, by place
  quantum: number; // a value is off by at most half of it
}

interface ColumnFormat {
  components: number; // values per sphere, at most 3
  encoded(frame: Frame): { quantum: number; spb: Uint8Array };
}

/** A column of this name is an input of the shaders: a_<name>From and a_<name>To (renderer/program.ts). */
export const columnFormats = {
  position: { components: 3, encoded: (frame) => frame }, // x y z (m), relative to the centre of the bounds
} satisfies Record<string, ColumnFormat>;

export type ColumnName = keyof typeof columnFormats;

/** The columns of one state. They share one buffer, one after another. */
export type Columns = Record<ColumnName, Column>;

export const columnNames = Object.keys(columnFormats) as ColumnName[];

/** Values per sphere, over all columns. */
export const valuesPerSphere = columnNames.reduce((sum, name) => sum + columnFormats[name].components, 0);

export function bufferOf(columns: Columns): ArrayBuffer {
  return columns.position.values.buffer as ArrayBuffer;
}
