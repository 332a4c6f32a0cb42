// A reader of keyframes after docs/codec.md, independent of the page's decoder. It is simple and slow.

const widths = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 18, 32];
const wide = 0b1111; // mode with base, predictor none

/** Returns the positions in grid units, [x, y, z] per sphere, in the frame's order. */
export function readKeyframe(bytes) {
  const unit = (at) => bytes.readUInt16LE(2 * at);
  const spheres = bytes.readUInt32LE(4);
  const isKeyframe = bytes.readUInt16LE(0) === 0x5053 && bytes[2] === 1 && (bytes[3] & 1) === 1;
  if (!isKeyframe) throw new Error("no keyframe of version 1");
  const blocks = Math.ceil(spheres / 64);
  const positions = [];
  let at = 2 * (4 + Math.ceil(blocks / 256)); // in units of 16 bits, after head and table
  for (let block = 0; block < blocks; block++) {
    if (block % 32 === 0) at += (at % 2) + 2; // to a whole word, and over the bitmap, whose bits are all set
    at = readBlock(unit, at, positions);
  }
  return positions.slice(0, spheres);
}

/** Appends 64 positions; returns the unit after the block. */
function readBlock(unit, at, positions) {
  const header = unit(at);
  if ((header & 15) !== wide) throw new Error("a block of a keyframe that is not coded around a base");
  let bit = 16 * (at + 10); // after header, selectors and base
  const axes = [0, 1, 2].map((axis) => {
    const code = (header >> (4 + 4 * axis)) & 15;
    const base = unit(at + 4 + 2 * axis) | (unit(at + 5 + 2 * axis) << 16);
    return Array.from({ length: 64 }, (_, k) => {
      const width = widths[Math.max(0, code - ((unit(at + 1 + axis) >> (2 * (k >> 3))) & 3))];
      let value = 0;
      for (let i = 0; i < width; i++, bit++) value |= ((unit(bit >> 4) >> (bit & 15)) & 1) << i;
      return (base + ((value >>> 1) ^ -(value & 1))) | 0;
    });
  });
  for (let k = 0; k < 64; k++) positions.push(axes.map((values) => values[k]));
  return Math.ceil(bit / 16);
}
