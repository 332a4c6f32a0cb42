// Decodes the frames at these addresses, as the page's worker does, in turns for some rounds; answers with the times in ms.
import { Decoder } from "../src/codec/decoder";
import { scatter } from "../src/connection/scatter";

const fetched = async (address: string): Promise<ArrayBuffer> => (await fetch(address)).arrayBuffer();

onmessage = async ({ data }: MessageEvent<{ frames: string[]; order: string; rounds: number }>) => {
  const frames = await Promise.all(data.frames.map(async (address) => new Uint8Array(await fetched(address))));
  for (const frame of frames) frame[3] = (frame[3] as number) & ~2; // one frame a second has a hash: not part of what is timed
  const places = new Uint32Array(await fetched(data.order)).map((id) => 3 * id);
  const decoder = new Decoder(places.length);
  const metres = new Float32Array(3 * places.length);
  const times: Record<string, number[]> = { keyframe: [], delta: [], metres: [] };
  for (let round = 0; round <= data.rounds; round++) {
    for (const frame of frames) {
      const begin = performance.now();
      const { keyframe } = decoder.apply(frame);
      const decoded = performance.now();
      scatter(decoder.newest, places, 0.001, metres);
      const done = performance.now();
      if (round === 0) continue; // the engine has yet to see what is worth compiling
      times[keyframe ? "keyframe" : "delta"]?.push(decoded - begin);
      times["metres"]?.push(done - decoded);
    }
  }
  postMessage(times);
};
