// Mutations of frames.
import { draw, word } from "./random.mjs";

const words = [0, 1, 2, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff];

function flipBits(frame) {
  for (let k = 1 + draw(8); k > 0; k--) frame[draw(frame.length)] ^= 1 << draw(8);
  return frame;
}

function setBytes(frame) {
  for (let k = 1 + draw(4); k > 0; k--) frame[draw(frame.length)] = draw(256);
  return frame;
}

/** Sets a word of the head, the table or the first groups: lengths, bitmaps, headers of blocks. */
function setWord(frame) {
  const at = 4 * draw(Math.min(12, frame.length >> 2));
  const value = draw(3) === 0 ? word() : words[draw(words.length)];
  for (let k = 0; k < 4 && at + k < frame.length; k++) frame[at + k] = value >>> (8 * k);
  return frame;
}

function truncate(frame) {
  return frame.subarray(0, draw(frame.length));
}

function extend(frame) {
  const longer = new Uint8Array(frame.length + 1 + draw(20));
  longer.set(frame);
  for (let k = frame.length; k < longer.length; k++) longer[k] = draw(256);
  return longer;
}

/** Joins the beginning of one frame and the end of the other. */
function splice(frame, other) {
  const at = draw(frame.length);
  const rest = other.subarray(draw(other.length));
  const both = new Uint8Array(at + rest.length);
  both.set(frame.subarray(0, at));
  both.set(rest, at);
  return both;
}

/** Copies a part of the frame to another place in it. */
function copyWithin(frame) {
  frame.copyWithin(draw(frame.length), draw(frame.length), frame.length);
  return frame;
}

/** Replaces all bytes, or all after the head, by random ones. */
function noise(frame) {
  for (let k = draw(2) === 0 ? 0 : 20; k < frame.length; k++) frame[k] = draw(256);
  return frame;
}

/** Makes the chunk end with the frame, so that the decoder reads beyond the table. */
function repair(frame) {
  if (frame.length < 24) return frame;
  const whole = frame.slice(0, frame.length & ~3);
  new DataView(whole.buffer).setUint32(16, (whole.length >> 2) - 5, true);
  return whole;
}

const flips = [flipBits, flipBits, flipBits];
const changes = [...flips, setBytes, setBytes, setWord, truncate, extend, splice, copyWithin, noise];

/** Returns a copy of `frame` with one to four mutations. `other`: a frame from which parts are copied. */
export function mutate(frame, other) {
  let changed = frame.slice();
  for (let k = draw(4) === 0 ? 1 + draw(3) : 1; k > 0 && changed.length > 0; k--) {
    changed = changes[draw(changes.length)](changed, other);
  }
  if (draw(2) === 0) changed = repair(changed);
  // Most frames lose their hash flag: the hash would refuse nearly all mutated frames.
  if (changed.length > 3 && draw(8) !== 0) changed[3] &= ~2;
  return changed;
}
