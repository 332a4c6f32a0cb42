/** Reads the values of a block of which some are not there. */

/** A field of `width` bits, 0 to 32, from `bit` on; five bytes must exist. */
export function field(view: DataView, bit: number, width: number): number {
  const byte = bit >>> 3;
  const shift = bit & 7;
  const low = view.getInt32(byte, true) >>> shift;
  if (width <= 25) return low & ((1 << width) - 1);
  return (low | ((view.getUint8(byte + 4) << 1) << (31 - shift))) & (-1 >>> (32 - width));
}

/** The bits set in a byte. */
export const bitCount = new Uint8Array(256);
for (let k = 1; k < 256; k++) bitCount[k] = (bitCount[k >> 1] as number) + (k & 1);

/** Moves those of a run's eight that `changed` has a bit for, by a field plus 1 each; on one axis, the first at `to`. */
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
