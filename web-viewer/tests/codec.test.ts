import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { Decoder } from "../src/codec/decoder";
import { widths } from "../src/codec/format";
import { hashOf } from "../src/codec/hash";
import { move } from "../src/codec/move";
import { field } from "../src/codec/values";

// Tests run in web-viewer/. The C++ tests read the same files.
const golden = (name: string) => new Uint8Array(readFileSync(path.join("..", "tests", "golden", "codec", name)));
const frames = Array.from({ length: 8 }, (_, k) => golden(`frame-${k}.spb`));
const frame = (k: number): Uint8Array => frames[k] as Uint8Array;
const expected = new Int32Array(golden("positions.i32").buffer);
const spheres = 583;

function positionsOf(decoder: Decoder): Int32Array {
  return decoder.newest.subarray(0, 3 * spheres);
}

test("the golden frames give the golden positions", () => {
  const decoder = new Decoder(spheres);
  frames.forEach((bytes, k) => {
    const head = decoder.apply(bytes);
    assert.equal(head.keyframe, k === 0 || k === 5);
    assert.equal(head.hash, hashOf(decoder.newest, spheres));
  });
  assert.deepEqual(positionsOf(decoder), expected);
});

test("a decoder that starts at a later keyframe has the same positions", () => {
  const decoder = new Decoder(spheres);
  for (let k = 5; k < 8; k++) decoder.apply(frame(k));
  assert.deepEqual(positionsOf(decoder), expected);
});

test("a frame may lie anywhere in a message", () => {
  const decoder = new Decoder(spheres);
  frames.forEach((bytes, k) => {
    const message = new Uint8Array(bytes.length + 16).fill(255);
    message.set(bytes, 1 + k);
    decoder.apply(message.subarray(1 + k, 1 + k + bytes.length));
  });
  assert.deepEqual(positionsOf(decoder), expected);
});

test("a missing frame is detected, and a keyframe restores the chain", () => {
  const decoder = new Decoder(spheres);
  assert.throws(() => decoder.apply(frame(1)), /is no keyframe, and none came before/);
  decoder.apply(frame(0));
  assert.throws(() => decoder.apply(frame(2)), /is number 3, which does not follow 1/);
  assert.ok(decoder.wantsKeyframe);
  decoder.apply(frame(5));
  assert.ok(!decoder.wantsKeyframe);
});

test("a velocity right after a keyframe is refused", () => {
  const decoder = new Decoder(spheres);
  decoder.apply(frame(0));
  decoder.apply(frame(1));
  const next = frame(2).slice();
  new DataView(next.buffer).setUint32(8, 6, true); // as if it followed frame 5
  decoder.apply(frame(5));
  assert.throws(() => decoder.apply(next), /block \d+: is predicted from a velocity right after a keyframe/);
});

/** Decodes one block of 64 spheres at (5, 6, -7), then a delta frame with these words in its group. */
const still = Uint32Array.of(0x01015053, 64, 1, 0, 6, 1, 0x000f, 0, 5, 6, 0xfffffff9);
function after(group: number[]): Int32Array {
  const decoder = new Decoder(64);
  decoder.apply(new Uint8Array(still.buffer));
  decoder.apply(new Uint8Array(Uint32Array.of(0x00015053, 64, 2, 0, group.length, ...group).buffer));
  return decoder.newest;
}

test("frames made by hand decode as docs/codec.md specifies", () => {
  assert.deepEqual([...after([0]).subarray(0, 3)], [5, 6, -7]);
  const masked = after([1, 0x20212011, 0x01010220, 0x00000a01]);
  assert.deepEqual([...masked.subarray(0, 6)], [5, 6, -7, 4, 6, -7]);
  assert.deepEqual([...masked.subarray(120, 123)], [6, 5, -9]);
});

test("errors say what is wrong, and where", () => {
  const refused = (words: number[], reason: RegExp) =>
    assert.throws(() => new Decoder(64).apply(new Uint8Array(Uint32Array.from(words).buffer)), reason);
  const key = 0x01015053;
  refused([key, 64, 1], /head: has 12 bytes of 16/);
  refused([0x00025053, 64, 1, 0], /head: is not a head of codec SPB, version 1/);
  refused([key, 0, 1, 0], /head: has no spheres/);
  refused([key, 65, 1, 0], /head: has 65 spheres where there are 64/);
  refused([key, 64, 1, 0], /table: goes beyond the end/);
  refused([key, 64, 1, 0, 0xffffffff], /chunk 0: ends outside of the frame/);
  refused([key, 64, 1, 0, 0], /group of block 0: goes beyond its chunk/);
  refused([key, 64, 1, 0, 1, 2], /group of block 0: has blocks that do not exist/);
  refused([key, 64, 1, 0, 1, 0], /block 0: is missing in a keyframe/);
  refused([key, 64, 1, 0, 1, 1], /block 0: goes beyond its chunk/);
  refused([key, 64, 1, 0, 2, 1, 0], /block 0: is predicted in a keyframe/);
  refused([key, 64, 1, 0, 2, 1, 0x000c], /block 0: has no base/);
  refused([...still, 8], /end: differs from the end of the last chunk/);
  assert.throws(() => after([1, 0xfff0]), /block 0: goes beyond its chunk/);
  assert.throws(() => after([1, 0x000f, 0, 0, 0, 0]), /block 0: is not predicted in a delta frame/);
  assert.throws(() => after([1, 0, 0]), /chunk 0: does not end where its groups do/);
});

test("corrupted frames are refused or decoded", () => {
  let random = 1;
  const draw = (below: number): number => {
    random = (Math.imul(random, 1664525) + 1013904223) >>> 0;
    return Math.floor((random / 2 ** 32) * below);
  };
  let refused = 0;
  for (let round = 0; round < 300; round++) {
    const decoder = new Decoder(spheres);
    for (const bytes of frames) {
      const corrupted = bytes.slice(0, draw(4) === 0 ? draw(bytes.length) : bytes.length);
      for (let k = draw(3); k > 0; k--) {
        const at = draw(corrupted.length);
        corrupted[at] = (corrupted[at] ?? 0) ^ (1 << draw(8));
      }
      try {
        decoder.apply(corrupted);
      } catch (error) {
        assert.match(String(error), /^Error: frame, /);
        refused++;
      }
    }
  }
  assert.ok(refused > 300);
});

/** Words with pseudo-random bits, and a plain reader of the field of `width` bits at `at`. */
const words = new Uint32Array(220).map((_, k) => Math.imul(k + 1, 0x9e3779b1));
const view = new DataView(words.buffer);
const bits = [...words].flatMap((word) => Array.from({ length: 32 }, (_, k) => (word >>> k) & 1));
const plainField = (at: number, width: number): number =>
  bits.slice(at, at + width).reduce((sum, one, k) => sum | (one << k), 0);

test("fields of every width are read at every bit", () => {
  for (let width = 0; width <= 32; width++) {
    for (let bit = 0; bit < 64; bit++) assert.equal(field(view, bit, width), plainField(bit, width));
  }
});

test("runs of every width move their spheres, with every predictor", () => {
  const newest = Int32Array.from({ length: 195 }, (_, k) => Math.imul(k + 3, 0x85ebca77));
  const last = Int32Array.from({ length: 195 }, (_, k) => Math.imul(k + 5, 0xc2b2ae3d));
  const base = Int32Array.of(-7, 0x7ffffff0, 512);
  const predicted = [
    (now: number) => now,
    (now: number, before: number) => 2 * now - before,
    (now: number, before: number) => now + (((now - before) | 0) >> 1),
    () => 0,
  ];
  for (const [predictor, from] of predicted.entries()) {
    for (const begin of [0, 1, 2, 3]) {
      const width = Uint8Array.from({ length: 24 }, (_, run) => widths[(7 * run + 5 * begin) % 16] as number);
      const expect = last.slice();
      let bit = 8 * begin;
      for (let run = 0; run < 24; run++) {
        const wide = width[run] as number;
        for (let k = 0; k < 8; k++, bit += wide) {
          const at = 3 + 3 * (8 * (run % 8) + k) + (run >> 3);
          const value = plainField(bit, wide);
          const residual = (value >>> 1) ^ -(value & 1);
          expect[at] = from(newest[at] as number, last[at] as number) + (base[run >> 3] as number) + residual;
        }
      }
      const moved = last.slice();
      move(predictor, view, begin, width, base, newest, moved, 3);
      assert.deepEqual(moved, expect);
    }
  }
});

test("coordinates with turns count modulo their turns", () => {
  const decoder = new Decoder(64);
  const apply = (words: number[]) => decoder.apply(new Uint8Array(Uint32Array.from(words).buffer));
  apply([0x05015053, 64, 1, 0, 100, 0, 0, 6, 1, 0x000f, 0, 49, 6, 0xfffffff9]);
  assert.deepEqual(decoder.turns, [100, 0, 0]);
  assert.deepEqual([...decoder.newest.subarray(0, 3)], [49, 6, -7]);
  const group = [1, 0x20212011, 0x01010220, 0x00000a01];
  apply([0x04015053, 64, 2, 0, 100, 0, 0, group.length, ...group]);
  assert.deepEqual([...decoder.newest.subarray(0, 6)], [49, 6, -7, 48, 6, -7]);
  assert.deepEqual([...decoder.newest.subarray(120, 123)], [-50, 5, -9]);
  assert.throws(() => apply([0x04015053, 64, 3, 0, 101, 0, 0, 1, 0]), /head: has other turns than the frame before/);
});

test("invalid turns are refused", () => {
  const refused = (turns: number[], reason: RegExp) => {
    const words = [0x05015053, 64, 1, 0, ...turns, 6, 1, 0x000f, 0, 5, 6, 7].slice(0, 4 + turns.length + 7);
    assert.throws(() => new Decoder(64).apply(new Uint8Array(Uint32Array.from(words).buffer)), reason);
  };
  refused([1, 0, 0], /head: has 1 turns/);
  refused([0, 0, 2 ** 30 + 1], /head: has 1073741825 turns/);
  refused([0, 0, 0], /head: has no turns/);
  const short = Uint32Array.of(0x05015053, 64, 1, 0, 100);
  assert.throws(() => new Decoder(64).apply(new Uint8Array(short.buffer)), /head: has 20 bytes of 28/);
});
