// node tools/bench_codec.mjs FOLDER: times the page's decoder, in one thread, on frame-0.spb, frame-1.spb, ... in
// FOLDER, an output of `spherule_codec_bench --frames FOLDER`.
import { existsSync, readFileSync } from "node:fs";
import path from "node:path";
import { loadDecoder } from "./decoder.mjs";

const folder = process.argv[2];
if (!folder) throw new Error("no folder given");
const frames = [];
while (existsSync(path.join(folder, `frame-${frames.length}.spb`))) {
  frames.push(new Uint8Array(readFileSync(path.join(folder, `frame-${frames.length}.spb`))));
}

const { Decoder } = await loadDecoder();
const spheres = new DataView(frames[0].buffer).getUint32(4, true);
const decoder = new Decoder(spheres);
const times = { keyframe: [], delta: [] };
for (let round = 0; round < 8; round++) {
  for (const frame of frames) {
    const plain = frame.slice();
    plain[3] &= ~2; // the check of the hash is not timed
    const begin = performance.now();
    const { keyframe } = decoder.apply(plain);
    if (round > 0) times[keyframe ? "keyframe" : "delta"].push(performance.now() - begin);
  }
}
for (const [kind, all] of Object.entries(times)) {
  all.sort((a, b) => a - b);
  const at = (share) => (all[Math.floor(share * (all.length - 1))] ?? 0).toFixed(1);
  console.log(`${spheres} spheres, ${kind}: median ${at(0.5)} ms, fastest ${at(0)} ms, ${all.length} frames`);
}
