/** The constants of docs/codec.md. */

export const blockSpheres = 64;
export const groupBlocks = 32;
export const chunkBlocks = 256;
export const headWords = 4;
export const turnsHeadWords = 7; // of a frame with turns
export const mostTurns = 2 ** 30;

export const magic = 0x00015053;
export const keyframeFlag = 0x01000000;
export const hashedFlag = 0x02000000;
export const turnsFlag = 0x04000000;

export const modeMask = 1;
export const modeRuns = 2;
export const modeBase = 3;

export const previous = 0;
export const linear = 1;
export const half = 2;
export const none = 3;

/** Bits per value, by width code. */
export const widths = Uint8Array.of(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 18, 32);
