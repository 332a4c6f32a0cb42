const idBytes = 3;

/**
 * Where the spheres of frames belong in an array x y z in id order: three times the id of each. `ids` holds three bytes per
 * sphere, little endian. Throws an Error where they are no permutation of 0 .. count - 1.
 */
export function placesOf(ids: Uint8Array, count: number): Uint32Array {
  if (ids.length !== idBytes * count) {
    throw new Error(`order: ${ids.length} bytes for ${count} spheres, which take ${idBytes * count}`);
  }
  const places = new Uint32Array(count);
  const seen = new Uint8Array(count);
  for (let k = 0, at = 0; k < count; k++, at += idBytes) {
    const id = (ids[at] as number) | ((ids[at + 1] as number) << 8) | ((ids[at + 2] as number) << 16);
    if (id >= count) throw new Error(`order: sphere ${k} has id ${id}, of ${count} spheres`);
    if (seen[id] === 1) throw new Error(`order: id ${id} is there twice`);
    seen[id] = 1;
    places[k] = 3 * id;
  }
  return places;
}
