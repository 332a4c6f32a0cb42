import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Decoder } from "../src/codec/decoder";
import { Encoder } from "../src/codec/encoder";
import { noTurns } from "../src/codec/turns";
import type { Turns } from "../src/codec/turns";

/** Random integers, the same in every run. */
function randomFrom(seed: number): (below: number) => number {
  let state = seed;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

function same(decoder: Decoder, positions: Int32Array): void {
  assert.deepEqual(decoder.newest.subarray(0, positions.length), positions);
}

/** Moves spheres by steps of any size; most of the time like in the frame before. */
function* frames(spheres: number, count: number, turns: Turns = noTurns): Generator<Int32Array> {
  const random = randomFrom(spheres);
  const largest = [1, 3, 200, 5000, 2 ** 20, 2 ** 29];
  const inside = (value: number, each: number): number => {
    const half = each >>> 1;
    return each > 0 ? ((((value + half) % each) + each) % each) - half : value;
  };
  const place = Int32Array.from({ length: 3 * spheres }, (_, k) => inside(random(2 ** 29), turns[k % 3] as number));
  const step = new Int32Array(place.length);
  for (let frame = 0; frame < count; frame++) {
    yield place.slice();
    const size = largest[random(largest.length)] as number;
    for (let k = 0; k < place.length; k++) {
      if (random(4) === 0) step[k] = random(3) === 0 ? 0 : random(2 * size) - size;
      if (frame % 5 === 3 && k < place.length / 2) step[k] = 0;
      place[k] = inside((place[k] as number) + (step[k] as number) / 4, turns[k % 3] as number);
    }
  }
}

for (const spheres of [1, 63, 64, 65, 583, 2049, 16_385]) {
  test(`${spheres} spheres are decoded as they were encoded, with and without turns`, () => {
    for (const turns of [noTurns, [1000, 0, 2 ** 20 + 1]] as Turns[]) {
      const encoder = new Encoder(spheres);
      const decoder = new Decoder(spheres);
      const late = new Decoder(spheres); // begins at the keyframe in the middle
      let number = 0;
      for (const positions of frames(spheres, 14, turns)) {
        number += 1;
        const { spb, keyframe } = encoder.encode(positions, turns, number % 2 === 1);
        assert.equal(keyframe, number === 1);
        decoder.apply(spb);
        if (number > 7) late.apply(spb);
        same(decoder, positions);
        if (number === 7) late.apply(encoder.resync());
        if (number >= 7) same(late, positions);
      }
    }
  });
}

test("frames in which nothing moves have no blocks", () => {
  const encoder = new Encoder(640);
  const [positions] = [...frames(640, 1)] as [Int32Array];
  encoder.encode(positions, noTurns, false);
  assert.equal(encoder.encode(positions, noTurns, false).spb.byteLength, 4 * (4 + 1 + 1));
});

test("even motion takes few bits, because steps are predicted", () => {
  const encoder = new Encoder(640);
  const [positions] = [...frames(640, 1)] as [Int32Array];
  const sizes = [0, 1, 2, 3].map((frame) => {
    return encoder.encode(
      positions.map((q) => q + 1000 * frame),
      noTurns,
      false,
    ).spb.byteLength;
  });
  assert.ok((sizes[2] as number) < (sizes[1] as number) / 5, String(sizes));
});

test("the server's frames are encoded to at most a third more bytes", () => {
  const read = (k: number): Uint8Array => readFileSync(`../tests/golden/codec/frame-${k}.spb`);
  const decoder = new Decoder(583);
  const encoder = new Encoder(583);
  let [theirs, ours] = [0, 0];
  for (const k of [0, 1, 2, 3, 4]) {
    decoder.apply(read(k));
    theirs += read(k).byteLength;
    ours += encoder.encode(decoder.newest, decoder.turns, true).spb.byteLength;
  }
  assert.ok(ours < (4 / 3) * theirs, `${ours} bytes, the server has ${theirs}`);
});
