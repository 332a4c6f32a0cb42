import { css, hexToRgb, mix } from "./rgb";
import type { Rgb } from "./rgb";

/** Six evenly spaced stops in sRGB. The shader interpolates between the same stops (renderer/shaders/colour.glsl). */
export type Ramp = readonly [Rgb, Rgb, Rgb, Rgb, Rgb, Rgb];

function ramp(...hex: [string, string, string, string, string, string]): Ramp {
  return hex.map((stop) => hexToRgb(stop) ?? [0, 0, 0]) as unknown as Ramp;
}

// The lightness of every ramp rises from stop to stop, also for people who see no difference of red and green
// (tests/colour.test.ts).

/** From rest to high speed: blue, sea green, sand. */
export const speedRamp = ramp("#3f5a9b", "#3f7fae", "#56a3a8", "#8bc193", "#cbd880", "#f7efb2");
/** Small to large. */
export const radiusRamp = ramp("#8a5a83", "#b06a7c", "#cf8470", "#dfa66e", "#e3cb88", "#dfe6b4");
/** First to last. */
export const idRamp = ramp("#4a4587", "#5c6cb3", "#6f95c6", "#8cbbcb", "#b5d9cc", "#e9f3da");
/** From none to many contacts. */
export const contactsRamp = ramp("#53407f", "#86498b", "#b85a80", "#dd7c70", "#f0aa6c", "#f7dc92");
/** From none to deep. */
export const overlapRamp = ramp("#44546a", "#6f6378", "#a0707a", "#cc8472", "#e8a979", "#f6dca6");
/** From rest to high energy. */
export const energyRamp = ramp("#6b3a4f", "#9c4a49", "#c66645", "#dd8d4b", "#e9b966", "#f3e5a5");
/** From low to high: pine, moss, straw. */
export const heightRamp = ramp("#2f4858", "#35675f", "#4f8865", "#82a76a", "#bfc47a", "#f1e3a6");

export function rampColour(stops: Ramp, at: number): Rgb {
  const scaled = Math.min(1, Math.max(0, at)) * (stops.length - 1);
  const index = Math.min(stops.length - 2, Math.floor(scaled));
  return mix(stops[index] ?? stops[0], stops[index + 1] ?? stops[5], scaled - index);
}

export function rampGradient(stops: Ramp): string {
  return `linear-gradient(to right, ${stops.map(css).join(", ")})`;
}
