/** Hashes the first `spheres` positions, x y z each, in the codec's order. */
export function hashOf(positions: Int32Array, spheres: number): number {
  let sum = 0;
  for (let k = 0, at = 0; k < spheres; k++, at += 3) {
    let h = Math.imul((positions[at] as number) + Math.imul(k, 0x9e3779b1), 0x85ebca77);
    h ^= h >>> 15;
    h = Math.imul(h + (positions[at + 1] as number), 0xc2b2ae3d);
    h ^= h >>> 13;
    h = Math.imul(h + (positions[at + 2] as number), 0x27d4eb2f);
    h ^= h >>> 16;
    sum = (sum + h) | 0;
  }
  return sum >>> 0;
}
