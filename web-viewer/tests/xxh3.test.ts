import assert from "node:assert/strict";
import { test } from "node:test";
import { xxh3 } from "../src/archive/xxh3";

/** Hashes by the library xxHash 0.8 of the first bytes of the sequence below. */
const known: [length: number, hash: bigint][] = [
  [9, 0xb57726b2357ce8efn],
  [16, 0xffb6d8e399917d26n],
  [17, 0x9eeb0e0e90d24155n],
  [31, 0xcec2a91e7fa34d3en],
  [32, 0xa9018db70b05f222n],
  [33, 0x24673a275e072119n],
  [64, 0x42127026e89cab9fn],
  [65, 0xde52a5416e9fedden],
  [96, 0x5356d8175d1530cbn],
  [97, 0xefe4a9fd55af421dn],
  [128, 0xa94c1449d0e37ef7n],
  [129, 0x2d0ee71e76519f96n],
  [143, 0x420a9123da6e63b3n],
  [144, 0x2a2187db653efca5n],
  [200, 0x13399cafbe4ac86fn],
  [239, 0x582820afcdfea98bn],
  [240, 0xed8bd715ddb62d6bn],
  [241, 0xe97ad5df85e3dcfdn],
  [256, 0xf9899ca86f9026b0n],
  [320, 0x7552c694b6d29386n],
  [1023, 0x4b6ec7170e9e870en],
  [1024, 0x8932a613e3655f64n],
  [1025, 0x7e04b9e9f97cce53n],
  [1088, 0xed6b6e9b1495dc25n],
  [2048, 0xba3072712f5afb8an],
  [2049, 0xc64206503e4c14b2n],
  [4133, 0x6d4070b44937e895n],
  [65537, 0x0d58364259dbeec4n],
];

/** The upper bytes of a linear congruential sequence, from the fourth on. */
function sequence(length: number): Uint8Array {
  const bytes = new Uint8Array(length + 3);
  let state = 1;
  for (let k = 0; k < bytes.length; k++) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    bytes[k] = state >>> 24;
  }
  return bytes.subarray(3);
}

test("hashes equal those of the library, at every kind of length and place", () => {
  const whole = sequence(70_000);
  for (const [length, hash] of known) {
    assert.equal(xxh3(whole.subarray(0, length)), hash, `${length} bytes`);
    assert.equal(xxh3(whole.slice(0, length)), hash, `${length} bytes in a buffer of their own`);
  }
});

test("a changed bit changes the hash", () => {
  const bytes = sequence(5000);
  const hash = xxh3(bytes);
  for (const at of [0, 1023, 1024, 4095, 4999]) {
    bytes[at] = (bytes[at] as number) ^ 4;
    assert.notEqual(xxh3(bytes), hash);
    bytes[at] = bytes[at] ^ 4;
  }
});
