// Valid frames of docs/codec.md with random blocks, including blocks that no encoder would choose.
import { draw, word } from "./random.mjs";

const widths = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 18, 32];
const modeMask = 1;
const modeBase = 3;
const none = 3;

/** Units of 16 bits. */
class Units {
  list = [];
  /** Appends `count` random bits. */
  bits(count) {
    for (let left = count; left > 0; left -= 16) this.list.push(word() & (left < 16 ? (1 << left) - 1 : 0xffff));
  }
}

/** Draws a width code, mostly a narrow one, because wide values make frames long. */
function drawCode() {
  return draw(12) === 0 ? draw(16) : draw(6);
}

function drawBlock(units, keyframe, velocities) {
  const mode = keyframe ? modeBase : draw(4);
  const predictor = keyframe ? none : velocities ? draw(3) : 0;
  const codes = [drawCode(), drawCode(), drawCode()];
  units.list.push(mode | (predictor << 2) | (codes[0] << 4) | (codes[1] << 8) | (codes[2] << 12));
  if (mode === modeMask) return drawMasked(units, codes);
  const selectors = mode > modeMask ? [word() & 0xffff, word() & 0xffff, word() & 0xffff] : [0, 0, 0];
  if (mode > modeMask) units.list.push(...selectors);
  if (mode === modeBase) for (let k = keyframe ? 6 : 2; k > 0; k--) units.list.push(word() & 0xffff);
  let sum = 0;
  for (let run = 0; run < 24; run++) {
    const axis = run >> 3;
    sum += 8 * widths[Math.max(0, codes[axis] - ((selectors[axis] >> (2 * (run & 7))) & 3))];
  }
  units.bits(sum);
}

function drawMasked(units, codes) {
  const bytes = [draw(256) & draw(256), draw(256) & draw(256), draw(256)];
  let sum = 0;
  for (let run = 0; run < 24; run++) {
    if (!((bytes[run >> 3] >> (run & 7)) & 1)) continue;
    const changed = draw(256);
    bytes.push(changed);
    for (let bit = changed; bit !== 0; bit &= bit - 1) sum += widths[codes[run >> 3]];
  }
  // Values follow the masks directly. The masks may end in the middle of a unit.
  const odd = bytes.length & 1;
  for (let k = 0; k + 1 < bytes.length; k += 2) units.list.push(bytes[k] | (bytes[k + 1] << 8));
  if (odd) units.list.push(bytes.at(-1) | (sum > 0 ? draw(256) << 8 : 0));
  units.bits(Math.max(0, sum - 8 * odd));
}

/** Generates a frame of one chunk, so of at most 16384 spheres. `velocities`: two states are known. */
export function frameAt(spheres, number, keyframe, velocities) {
  const blocks = Math.ceil(spheres / 64);
  const words = [];
  for (let first = 0; first < blocks; first += 32) {
    const count = Math.min(32, blocks - first);
    const all = count === 32 ? 0xffffffff : (1 << count) - 1;
    const bitmap = keyframe ? all : word() & all;
    const units = new Units();
    for (let k = 0; k < count; k++) if ((bitmap >>> k) & 1) drawBlock(units, keyframe, velocities);
    const { list } = units;
    words.push(bitmap);
    for (let k = 0; k < list.length; k += 2) words.push(list[k] | ((list[k + 1] ?? 0) << 16));
  }
  const head = [0x00015053 | (keyframe ? 1 << 24 : 0), spheres, number, 0, words.length];
  return new Uint8Array(Uint32Array.from([...head, ...words]).buffer);
}
