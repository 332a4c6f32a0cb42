/** Reads the packed values of a block. The loops take 32-bit words: two at most hold a value. */

/** A field of `width` bits, 0 to 32, from `bit` on; words one behind it must exist. */
export function field(words: Uint32Array, bit: number, width: number): number {
  if (width === 0) return 0;
  const at = bit >>> 5;
  const shift = bit & 31;
  const value = ((words[at] as number) >>> shift) | (((words[at + 1] as number) << 1) << (31 - shift));
  return width === 32 ? value : value & ((1 << width) - 1);
}

/** Eight fields of `width` bits into values[to ..]. */
export function readRun(words: Uint32Array, bit: number, width: number, values: Int32Array, to: number): void {
  if (width === 0) {
    for (let k = 0; k < 8; k++) values[to + k] = 0;
    return;
  }
  if (width <= 4) {
    // All eight in one look.
    const at = bit >>> 5;
    const shift = bit & 31;
    const mask = (1 << width) - 1;
    let all = ((words[at] as number) >>> shift) | (((words[at + 1] as number) << 1) << (31 - shift));
    values[to] = all & mask;
    values[to + 1] = (all >>>= width) & mask;
    values[to + 2] = (all >>>= width) & mask;
    values[to + 3] = (all >>>= width) & mask;
    values[to + 4] = (all >>>= width) & mask;
    values[to + 5] = (all >>>= width) & mask;
    values[to + 6] = (all >>>= width) & mask;
    values[to + 7] = (all >>> width) & mask;
    return;
  }
  if (width <= 8) {
    // Four in a look.
    const mask = (1 << width) - 1;
    let at = bit >>> 5;
    let shift = bit & 31;
    let all = ((words[at] as number) >>> shift) | (((words[at + 1] as number) << 1) << (31 - shift));
    values[to] = all & mask;
    values[to + 1] = (all >>>= width) & mask;
    values[to + 2] = (all >>>= width) & mask;
    values[to + 3] = (all >>> width) & mask;
    bit += 4 * width;
    at = bit >>> 5;
    shift = bit & 31;
    all = ((words[at] as number) >>> shift) | (((words[at + 1] as number) << 1) << (31 - shift));
    values[to + 4] = all & mask;
    values[to + 5] = (all >>>= width) & mask;
    values[to + 6] = (all >>>= width) & mask;
    values[to + 7] = (all >>> width) & mask;
    return;
  }
  if (width <= 16) {
    // Two in a look.
    const mask = (1 << width) - 1;
    for (let k = to; k < to + 8; k += 2, bit += 2 * width) {
      const at = bit >>> 5;
      const shift = bit & 31;
      const both = ((words[at] as number) >>> shift) | (((words[at + 1] as number) << 1) << (31 - shift));
      values[k] = both & mask;
      values[k + 1] = (both >>> width) & mask;
    }
    return;
  }
  const mask = width === 32 ? -1 : (1 << width) - 1;
  for (let k = 0; k < 8; k++, bit += width) {
    const at = bit >>> 5;
    const shift = bit & 31;
    values[to + k] = (((words[at] as number) >>> shift) | (((words[at + 1] as number) << 1) << (31 - shift))) & mask;
  }
}

/** The bits set in a byte. */
export const bitCount = new Uint8Array(256);
for (let k = 1; k < 256; k++) bitCount[k] = (bitCount[k >> 1] as number) + (k & 1);

/** A field plus 1 for each bit of `changed`, 0 for the others. */
export function readChanged(
  words: Uint32Array,
  bit: number,
  width: number,
  changed: number,
  values: Int32Array,
  to: number,
): void {
  for (let k = 0; k < 8; k++) {
    if ((changed >> k) & 1) {
      values[to + k] = field(words, bit, width) + 1;
      bit += width;
    } else {
      values[to + k] = 0;
    }
  }
}
