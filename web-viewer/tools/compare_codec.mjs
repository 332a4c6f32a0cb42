// node tools/compare_codec.mjs PROGRAM [--seed N]: checks that the page's decoder and the server's agree bit by bit: on
// all positions, and on the frames that they refuse. PROGRAM is the test program `codec_chains`. The seed is random by
// default.
import { execFileSync } from "node:child_process";
import { randomInt } from "node:crypto";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { parseArgs } from "node:util";
import { loadDecoder } from "./decoder.mjs";

const { values, positionals } = parseArgs({ allowPositionals: true, options: { seed: { type: "string" } } });
const [program] = positionals;
if (!program) throw new Error("no program given");
const seed = values.seed ?? String(randomInt(2 ** 47));
console.log(`seed ${seed}`);

/** Reads numbers and bytes from a buffer, one after another. */
class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  get done() {
    return this.at === this.bytes.length;
  }
  number() {
    this.at += 4;
    return this.bytes.readUInt32LE(this.at - 4);
  }
  take(length) {
    this.at += length;
    if (this.at > this.bytes.length) throw new Error("the file of chains is cut off");
    return this.bytes.subarray(this.at - length, this.at);
  }
}

function chainsOf(seed) {
  const folder = mkdtempSync(path.join(tmpdir(), "spherule-chains-"));
  try {
    const file = path.join(folder, "chains");
    execFileSync(program, [seed, file], { stdio: "inherit" });
    return readFileSync(file);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

const { Decoder } = await loadDecoder();
const reader = new Reader(chainsOf(seed));
const seen = { chains: 0, taken: 0, refused: 0, positions: 0 };

function compare(what, positions, wanted, spheres) {
  const bytes = Buffer.from(positions.buffer, positions.byteOffset, 12 * spheres);
  if (!bytes.equals(wanted)) throw new Error(`${what}: other positions`);
  seen.positions += spheres;
}

function compareFrame(decoder, name) {
  const { spheres } = decoder;
  const frame = reader.take(reader.number());
  const taken = reader.number() === 1;
  const reason = reader.take(reader.number()).toString();
  let thrown = "";
  try {
    decoder.apply(frame);
  } catch (error) {
    thrown = error.message;
  }
  if (thrown !== reason) throw new Error(`${name}: "${thrown}" here, "${reason}" there`);
  if ((thrown === "") !== taken || decoder.wantsKeyframe === taken) {
    throw new Error(`${name}: decoded by one decoder, refused by the other`);
  }
  compare(name, decoder.newest, reader.take(12 * spheres), spheres);
  if (reader.number() === 1) compare(`${name}, the previous frame`, decoder.before, reader.take(12 * spheres), spheres);
  seen[taken ? "taken" : "refused"] += 1;
}

while (!reader.done) {
  const spheres = reader.number();
  const decoder = new Decoder(spheres);
  const frames = reader.number();
  for (let k = 0; k < frames; k++) compareFrame(decoder, `chain ${seen.chains} of ${spheres} spheres, frame ${k}`);
  seen.chains += 1;
}
const { chains, taken, refused, positions } = seen;
const counts = `${chains} chains, ${taken} frames taken, ${refused} refused, ${positions} positions`;
console.log(`${counts}: the same in both decoders`);
if (!(chains > 0 && taken > 500 && refused > 100)) throw new Error("too few frames were compared");
