import { hashedFlag, headWords, keyframeFlag, magic, mostTurns, turnsFlag, turnsHeadWords } from "./format";
import { noTurns } from "./turns";
import type { Turns } from "./turns";

export interface FrameHead {
  spheres: number;
  number: number;
  keyframe: boolean;
  hash: number | undefined; // of the positions after the frame; undefined if the frame has none
  turns: Turns;
  words: number; // before the table of chunks
}

/** Parses the head of a frame with this number of bytes. Throws an Error if there is no valid head. */
export function headOf(words: Uint32Array, bytes: number): FrameHead {
  if (bytes < 4 * headWords) throw new Error(`frame, head: has ${bytes} bytes of 16`);
  const [kind = 0, spheres = 0, number = 0, hash = 0] = words;
  const flags = keyframeFlag | hashedFlag | turnsFlag;
  if ((kind & ~flags) >>> 0 !== magic) throw new Error("frame, head: is not a head of codec SPB, version 1");
  if (spheres === 0) throw new Error("frame, head: has no spheres");
  const turns = (kind & turnsFlag) !== 0 ? turnsOf(words, bytes) : noTurns;
  return {
    spheres,
    number,
    keyframe: (kind & keyframeFlag) !== 0,
    hash: (kind & hashedFlag) !== 0 ? hash : undefined,
    turns,
    words: turns === noTurns ? headWords : turnsHeadWords,
  };
}

function turnsOf(words: Uint32Array, bytes: number): Turns {
  if (bytes < 4 * turnsHeadWords) throw new Error(`frame, head: has ${bytes} bytes of 28`);
  const turns: Turns = [words[4] as number, words[5] as number, words[6] as number];
  for (const each of turns) {
    if (each > mostTurns || each === 1) throw new Error(`frame, head: has ${each} turns`);
  }
  if (turns.every((each) => each === 0)) throw new Error("frame, head: has no turns");
  return turns;
}

/** Whether the frame's keyframe flag is set. The frame is not checked otherwise. */
export function isKeyframe(frame: Uint8Array): boolean {
  return ((frame[3] ?? 0) & (keyframeFlag >>> 24)) !== 0;
}
