const shift = 17; // bits of a float that the code of a speed leaves out
const codes = 1 << (31 - shift); // more than there are

/** Speeds by code, in units: the middle of the speeds that have the code. */
const speeds = tabulate();

function tabulate(): Float64Array {
  const bits = new DataView(new ArrayBuffer(4));
  bits.setFloat32(0, 1);
  const one = bits.getUint32(0);
  const table = new Float64Array(codes);
  for (let code = 1; code < codes; code++) {
    bits.setUint32(0, one + (code << shift) + (1 << (shift - 1)));
    table[code] = bits.getFloat32(0) - 1;
  }
  return table;
}

/**
 * Writes speeds (m/s), by place. `units`: three values per sphere, in frame order, of which the first one is the code
 * of a speed (docs/codec.md). `ids`: the place of each sphere in frame order. `unit`: m/s.
 */
export function speedsOf(units: Int32Array, ids: Uint32Array, unit: number, values: Float32Array): void {
  for (let k = 0; k < ids.length; k++) {
    values[ids[k] as number] = unit * (speeds[units[3 * k] as number] ?? Infinity);
  }
}
