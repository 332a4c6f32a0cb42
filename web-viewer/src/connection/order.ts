const idBytes = 3;

/**
 * Returns, for each sphere in frame order, its offset in an array x y z in id order: three times its id. `ids` holds
 * three bytes per sphere, little endian. Throws an Error if the ids are no permutation of 0 .. count - 1.
 */
export function positionOffsets(ids: Uint8Array, count: number): Uint32Array {
  if (ids.length !== idBytes * count) {
    throw new Error(`order: has ${ids.length} bytes, expected ${idBytes * count} for ${count} spheres`);
  }
  const offsets = new Uint32Array(count);
  const seen = new Uint8Array(count);
  for (let k = 0, at = 0; k < count; k++, at += idBytes) {
    const id = (ids[at] as number) | ((ids[at + 1] as number) << 8) | ((ids[at + 2] as number) << 16);
    if (id >= count) throw new Error(`order: sphere ${k} has id ${id}, but there are only ${count} spheres`);
    if (seen[id] === 1) throw new Error(`order: id ${id} occurs twice`);
    seen[id] = 1;
    offsets[k] = 3 * id;
  }
  return offsets;
}

/** Converts positions in frame order, in grid units, to metres in id order. `offsets`: see positionOffsets(). */
export function scatter(units: Int32Array, offsets: Uint32Array, quantum: number, metres: Float32Array): void {
  for (let k = 0, from = 0; k < offsets.length; k++, from += 3) {
    const to = offsets[k] as number;
    metres[to] = quantum * (units[from] as number);
    metres[to + 1] = quantum * (units[from + 1] as number);
    metres[to + 2] = quantum * (units[from + 2] as number);
  }
}
