import { hashedFlag, headWords, keyframeFlag, magic } from "./format";

export interface FrameHead {
  spheres: number;
  number: number;
  keyframe: boolean;
  /** Of the state after the frame, where the frame brings it. */
  hash: number | undefined;
}

/** Of the first words of a frame of so many bytes; throws an Error where they are no head. */
export function headOf(words: Uint32Array, bytes: number): FrameHead {
  if (bytes < 4 * headWords) throw new Error(`frame, head: has ${bytes} bytes of 16`);
  const [kind = 0, spheres = 0, number = 0, hash = 0] = words;
  if ((kind & ~(keyframeFlag | hashedFlag)) >>> 0 !== magic) throw new Error("frame, head: is not that of codec SPB, version 1");
  if (spheres === 0) throw new Error("frame, head: has no spheres");
  return {
    spheres,
    number,
    keyframe: (kind & keyframeFlag) !== 0,
    hash: (kind & hashedFlag) !== 0 ? hash : undefined,
  };
}

/** Whether the frame says of itself that it is a keyframe; all else of it may be wrong. */
export function isKeyframe(frame: Uint8Array): boolean {
  return ((frame[3] ?? 0) & (keyframeFlag >>> 24)) !== 0;
}
