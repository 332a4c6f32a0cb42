// Decodes the frames at the given addresses in several rounds, as the page's worker does. Replies with the times in ms.
import { Decoder } from "../src/codec/decoder";
import { scatter } from "../src/connection/order";

const fetched = async (address: string): Promise<ArrayBuffer> => (await fetch(address)).arrayBuffer();

onmessage = async ({ data }: MessageEvent<{ frames: string[]; order: string; rounds: number }>) => {
  const frames = await Promise.all(data.frames.map(async (address) => new Uint8Array(await fetched(address))));
  // One frame per second has a hash. Its check is not timed.
  for (const frame of frames) frame[3] = (frame[3] as number) & ~2;
  const ids = new Uint32Array(await fetched(data.order));
  const decoder = new Decoder(ids.length);
  const values = new Int32Array(3 * ids.length);
  const times: Record<string, number[]> = { keyframe: [], delta: [], places: [] };
  for (let round = 0; round <= data.rounds; round++) {
    for (const frame of frames) {
      const begin = performance.now();
      const { keyframe } = decoder.apply(frame);
      const decoded = performance.now();
      scatter(decoder.newest, ids, values);
      const done = performance.now();
      if (round === 0) continue; // warm-up: the engine compiles the code
      times[keyframe ? "keyframe" : "delta"]?.push(decoded - begin);
      times["places"]?.push(done - decoded);
    }
  }
  postMessage(times);
};
