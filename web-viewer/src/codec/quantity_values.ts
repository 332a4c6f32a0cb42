/** Values by code, in units: the middle of the values that have the code. */
const table = tabulate(17);

/** `shift`: the bits of a float that the code of a value leaves out. */
export function tabulate(shift: number): Float64Array {
  const codes = 1 << (31 - shift); // more than there are
  const bits = new DataView(new ArrayBuffer(4));
  bits.setFloat32(0, 1);
  const one = bits.getUint32(0);
  const values = new Float64Array(codes);
  for (let code = 1; code < codes; code++) {
    bits.setUint32(0, one + (code << shift) + (1 << (shift - 1)));
    values[code] = bits.getFloat32(0) - 1;
  }
  return values;
}

/**
 * Writes the values of a quantity, by place. `units`: three values per sphere, in frame order, of which the first one
 * is the code of a value (docs/codec.md). `ids`: the place of each sphere in frame order. `unit`: of the codes.
 */
export function valuesOf(units: Int32Array, ids: Uint32Array, unit: number, values: Float32Array): void {
  for (let k = 0; k < ids.length; k++) {
    values[ids[k] as number] = unit * (table[units[3 * k] as number] ?? Infinity);
  }
}
