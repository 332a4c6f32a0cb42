// Reads a keyframe as docs/codec.md says, bit by bit: slowly, and sharing no code with the page.

const widths = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 18, 32];
const unzigzag = (v) => (v % 2 === 0 ? v / 2 : -(v + 1) / 2);

class Bits {
  constructor(bytes, at) {
    this.bytes = bytes;
    this.bit = 8 * at;
  }
  take(count) {
    let value = 0;
    for (let i = 0; i < count; i++, this.bit++) value += ((this.bytes[this.bit >> 3] >> (this.bit & 7)) & 1) * 2 ** i;
    return value;
  }
  alignTo(bits) {
    this.bit = Math.ceil(this.bit / bits) * bits;
  }
}

/** The cells of all spheres, in the codec's order, x y z each. */
export function cellsOf(frame) {
  const word = (index) => frame.readUInt32LE(4 * index);
  const flags = frame[3];
  if (frame.readUInt16LE(0) !== 0x5053 || frame[2] !== 1 || (flags & 1) === 0) throw new Error("not a keyframe");
  const spheres = word(1);
  const blocks = Math.ceil(spheres / 64);
  const chunks = Math.ceil(spheres / 16384);
  const bits = new Bits(frame, 4 * (4 + chunks));
  const cells = [];
  for (let first = 0; first < blocks; first += 32) {
    bits.take(32); // in a keyframe all blocks are there
    for (let block = first; block < Math.min(blocks, first + 32); block++) {
      const header = bits.take(16);
      if ((header & 15) !== 15) throw new Error(`block ${block} is not one of a keyframe`);
      const selectors = Array.from({ length: 24 }, () => bits.take(2));
      const base = Array.from({ length: 3 }, () => bits.take(32) | 0);
      const axes = base.map((middle, axis) =>
        Array.from({ length: 64 }, (_, k) => {
          const code = ((header >> (4 + 4 * axis)) & 15) - selectors[8 * axis + (k >> 3)];
          return (unzigzag(bits.take(widths[Math.max(0, code)])) + middle) | 0;
        }),
      );
      for (let k = 0; k < 64 && cells.length < spheres; k++) cells.push(axes.map((values) => values[k]));
      bits.alignTo(16);
    }
    bits.alignTo(32);
  }
  return cells;
}
