import { blockPlaces } from "../columns";
import type { Quanta } from "../columns";

const idBytes = 3;

/**
 * Returns the place of each sphere in frame order, which messages call its id. `bytes` holds three bytes per sphere,
 * little endian. Throws an Error if the ids are no permutation of 0 .. count - 1.
 */
export function idsOf(bytes: Uint8Array, count: number): Uint32Array {
  if (bytes.length !== idBytes * count) {
    throw new Error(`order: has ${bytes.length} bytes, expected ${idBytes * count} for ${count} spheres`);
  }
  const ids = new Uint32Array(count);
  const seen = new Uint8Array(count);
  for (let k = 0, at = 0; k < count; k++, at += idBytes) {
    const id = (bytes[at] as number) | ((bytes[at + 1] as number) << 8) | ((bytes[at + 2] as number) << 16);
    if (id >= count) throw new Error(`order: sphere ${k} has id ${id}, but there are only ${count} spheres`);
    if (seen[id] === 1) throw new Error(`order: id ${id} occurs twice`);
    seen[id] = 1;
    ids[k] = id;
  }
  return ids;
}

/** Copies three values per sphere from frame order to `values`, by place. `ids`: see idsOf(). */
export function scatter(units: Int32Array, ids: Uint32Array, values: Int32Array): void {
  for (let k = 0, from = 0; k < ids.length; k++, from += 3) {
    const to = 3 * (ids[k] as number);
    values[to] = units[from] as number;
    values[to + 1] = units[from + 1] as number;
    values[to + 2] = units[from + 2] as number;
  }
}

/**
 * Writes the box of the positions in each block of the frame order: low and high corner (m), six values per block. They
 * are unbounded along periodic axes, where a position may belong to any image. `units`: three values per sphere, in
 * frame order. `periods`: the length of each periodic axis, else 0.
 */
export function boxesOf(
  units: Int32Array,
  count: number,
  quanta: Quanta,
  periods: readonly number[],
  boxes: Float64Array,
): void {
  for (let axis = 0; axis < 3; axis++) {
    const periodic = (periods[axis] ?? 0) > 0;
    for (let block = 0; block * blockPlaces < count; block++) {
      let low = Infinity;
      let high = -Infinity;
      const end = 3 * Math.min(count, (block + 1) * blockPlaces);
      for (let at = 3 * block * blockPlaces + axis; !periodic && at < end; at += 3) {
        const unit = units[at] as number;
        if (unit < low) low = unit;
        if (unit > high) high = unit;
      }
      boxes[6 * block + axis] = periodic ? -Infinity : low * quanta[axis as 0 | 1 | 2];
      boxes[6 * block + 3 + axis] = periodic ? Infinity : high * quanta[axis as 0 | 1 | 2];
    }
  }
}
