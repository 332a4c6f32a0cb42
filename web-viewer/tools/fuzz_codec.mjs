// node tools/fuzz_codec.mjs [--inputs N] [--seed S]: feeds the page's decoder mutated frames, in chains as a page
// receives them. The frames are golden ones, or generated at random. The decoder must decode each frame, or refuse it
// with an Error of its own, within 100 ms. The result must not depend on the bytes around the frame, the frame must not
// change, and the positions must not change after a refusal. Prints the seed, the numbers of frames taken and refused,
// and the speed. Exits with 1 and the input in hexadecimal if a rule is broken.
import { readFileSync } from "node:fs";
import path from "node:path";
import { parseArgs } from "node:util";
import { loadDecoder } from "./decoder.mjs";
import { draw, seedRandom } from "./fuzz/random.mjs";
import { frameAt } from "./fuzz/frames.mjs";
import { mutate } from "./fuzz/mutate.mjs";
import { root } from "./options.mjs";

const { values } = parseArgs({ options: { inputs: { type: "string", default: "1000000" }, seed: { type: "string" } } });
const inputs = Number(values.inputs);
const seed = Number(values.seed ?? Math.floor(2 ** 32 * Math.random()));
seedRandom(seed);
console.log(`seed ${seed}`);

const patience = 100; // ms of processor time per frame; independent of other load
const margin = 64; // bytes around the frame
const { Decoder } = await loadDecoder();
const golden = Array.from(
  { length: 8 },
  (_, k) => new Uint8Array(readFileSync(path.join(root, `../tests/golden/codec/frame-${k}.spb`))),
);
const goldenSpheres = 583;

const seen = { taken: 0, refused: 0, slowest: 0 };
const reasons = new Map();

class Broken extends Error {}

/** Places the frame between other bytes, at a random offset. */
function placed(frame, around) {
  const begin = margin + draw(8);
  const whole = new Uint8Array(begin + frame.length + margin).fill(around);
  whole.set(frame, begin);
  return { whole, view: whole.subarray(begin, begin + frame.length) };
}

function feed(decoder, view) {
  const begin = process.cpuUsage();
  let reason = "";
  try {
    decoder.apply(view);
  } catch (error) {
    // A RangeError or TypeError is not intended by the decoder.
    if (error.constructor !== Error || !error.message.startsWith("frame, ")) throw new Broken(`throws ${error.stack}`);
    reason = error.message;
  }
  const { user, system } = process.cpuUsage(begin);
  const took = (user + system) / 1000;
  return { reason, took };
}

/** Feeds a frame to two decoders, the second among other bytes. */
function check(pair, frame) {
  const [one, other] = pair;
  const around = draw(256);
  const first = placed(frame, around);
  const before = one.newest;
  const state = draw(16) === 0 ? before.slice() : undefined;
  const { reason, took } = feed(one, first.view);
  const again = feed(other, placed(frame, 255 - around).view);
  if (again.reason !== reason) throw new Broken("depends on the bytes around the frame");
  // Processor time may include time of a virtual machine's host. A slow frame is slow in both decoders.
  const least = Math.min(took, again.took);
  seen.slowest = Math.max(seen.slowest, least);
  if (least > patience) throw new Broken(`takes ${least} ms`);
  if (one.wantsKeyframe !== (reason !== "")) {
    throw new Broken("wants a keyframe after a decoded frame, or none after a refused frame");
  }
  const begin = first.view.byteOffset;
  if (first.whole.subarray(begin, begin + frame.length).some((byte, k) => byte !== frame[k])) {
    throw new Broken("changes the frame");
  }
  const kept = reason !== "" && !reason.includes("another hash");
  if (kept && (one.newest !== before || state?.some((q, k) => q !== before[k]))) {
    throw new Broken("changes its positions although it refuses the frame");
  }
  if (draw(8) === 0 && one.newest.some((q, k) => q !== other.newest[k])) {
    throw new Broken("gives positions that depend on the bytes around the frame");
  }
  seen[reason ? "refused" : "taken"] += 1;
  if (reason) {
    const kind = reason.replaceAll(/\d+/g, "#");
    reasons.set(kind, (reasons.get(kind) ?? 0) + 1);
  }
}

/** Feeds a chain of frames, most of them mutated. Unmutated frames in between keep the chain going. */
function chain(left) {
  const fromGolden = draw(3) === 0;
  const spheres = fromGolden ? goldenSpheres : [1, 7, 64, 65, 200, 2048, 2500][draw(7)];
  const pair = [new Decoder(spheres), new Decoder(spheres)];
  const length = Math.min(left, 8 + draw(24));
  let number = 0;
  let previous = golden[0];
  for (let k = 0; k < length; k++) {
    const { wantsKeyframe } = pair[0];
    const frame = fromGolden
      ? golden[wantsKeyframe ? 5 * draw(2) : draw(8)]
      : frameAt(spheres, number + 1, wantsKeyframe || draw(12) === 0, number > 1);
    const mutated = draw(4) === 0 ? frame : mutate(frame, previous);
    previous = frame;
    try {
      check(pair, mutated);
    } catch (error) {
      if (!(error instanceof Broken)) throw error;
      const hex = Buffer.from(mutated).toString("hex");
      console.error(`a frame of a chain of ${spheres} spheres: ${error.message}\n${hex}`);
      process.exit(1);
    }
    const [decoder] = pair;
    number = decoder.wantsKeyframe ? 0 : new DataView(mutated.buffer, mutated.byteOffset).getUint32(8, true);
  }
  return length;
}

const begun = performance.now();
let lastReport = begun;
let done = 0;
while (done < inputs) {
  done += chain(inputs - done);
  const now = performance.now();
  if (now - lastReport < 60_000) continue;
  lastReport = now;
  console.log(`${done} inputs, ${Math.round((1000 * done) / (now - begun))} per second`);
}
const rate = (1000 * done) / (performance.now() - begun);
const counts = `${seen.taken} taken, ${seen.refused} refused, slowest ${seen.slowest.toFixed(1)} ms`;
console.log(`${done} inputs, ${Math.round(rate)} per second: ${counts}`);
for (const [reason, count] of [...reasons].sort((a, b) => b[1] - a[1])) {
  console.log(`${String(count).padStart(9)}  ${reason}`);
}
if (!(seen.taken > inputs / 20 && seen.refused > inputs / 20)) {
  throw new Error("nearly all frames were taken, or nearly all refused: the inputs are too uniform");
}
