/** Reads the values of blocks in mode mask, in which unchanged values are left out. */

/** Reads a field of `width` bits (0 to 32) at `bit`. Five bytes must exist there. */
export function field(view: DataView, bit: number, width: number): number {
  const byte = bit >>> 3;
  const shift = bit & 7;
  const low = view.getInt32(byte, true) >>> shift;
  if (width <= 25) return low & ((1 << width) - 1);
  return (low | ((view.getUint8(byte + 4) << 1) << (31 - shift))) & (-1 >>> (32 - width));
}

/** The number of bits set in a byte. */
export const bitCount = new Uint8Array(256);
for (let k = 1; k < 256; k++) bitCount[k] = (bitCount[k >> 1] as number) + (k & 1);

/** Moves the spheres of a run whose bit is set in `changed`, on one axis. `to`: index of the run's first sphere. */
export function moveChanged(
  view: DataView,
  bit: number,
  width: number,
  changed: number,
  positions: Int32Array,
  to: number,
): void {
  for (let rest = changed; rest !== 0; rest >>>= 1, to += 3) {
    if ((rest & 1) === 0) continue;
    const value = (field(view, bit, width) + 1) | 0;
    positions[to] = (positions[to] as number) + ((value >>> 1) ^ -(value & 1));
    bit += width;
  }
}
