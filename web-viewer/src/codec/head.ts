import { hashedFlag, headWords, keyframeFlag, magic } from "./format";

export interface FrameHead {
  spheres: number;
  number: number;
  keyframe: boolean;
  hash: number | undefined; // of the positions after the frame; undefined if the frame has none
}

/** Parses the head of a frame with this number of bytes. Throws an Error if there is no valid head. */
export function headOf(words: Uint32Array, bytes: number): FrameHead {
  if (bytes < 4 * headWords) throw new Error(`frame, head: has ${bytes} bytes of 16`);
  const [kind = 0, spheres = 0, number = 0, hash = 0] = words;
  const flags = keyframeFlag | hashedFlag;
  if ((kind & ~flags) >>> 0 !== magic) throw new Error("frame, head: is not a head of codec SPB, version 1");
  if (spheres === 0) throw new Error("frame, head: has no spheres");
  return {
    spheres,
    number,
    keyframe: (kind & keyframeFlag) !== 0,
    hash: (kind & hashedFlag) !== 0 ? hash : undefined,
  };
}

/** Whether the frame's keyframe flag is set. The frame is not checked otherwise. */
export function isKeyframe(frame: Uint8Array): boolean {
  return ((frame[3] ?? 0) & (keyframeFlag >>> 24)) !== 0;
}
