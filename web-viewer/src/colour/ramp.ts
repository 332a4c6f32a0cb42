import { css, hexToRgb, mix } from "./rgb";
import type { Rgb } from "./rgb";

/** Six evenly spaced stops in sRGB. The shader interpolates between the same stops (renderer/shaders/colour.glsl). */
export type Ramp = readonly [Rgb, Rgb, Rgb, Rgb, Rgb, Rgb];

function ramp(...hex: [string, string, string, string, string, string]): Ramp {
  return hex.map((stop) => hexToRgb(stop) ?? [0, 0, 0]) as unknown as Ramp;
}

/** From rest to high speed: light slate blue, sea green, sand, coral. Lightness rises as far as the sand. */
export const speedRamp = ramp("#6d98c4", "#60adbd", "#8cc7a6", "#e3db8c", "#f2ab63", "#df5f49");
/** Small to large. */
export const radiusRamp = ramp("#8a5a83", "#b06a7c", "#cf8470", "#dfa66e", "#e3cb88", "#dfe6b4");
/** First to last. */
export const idRamp = ramp("#4b5d9a", "#5a8fb4", "#6db5a6", "#a9c47f", "#e0b56a", "#d4796a");

export function rampColour(stops: Ramp, at: number): Rgb {
  const scaled = Math.min(1, Math.max(0, at)) * (stops.length - 1);
  const index = Math.min(stops.length - 2, Math.floor(scaled));
  return mix(stops[index] ?? stops[0], stops[index + 1] ?? stops[5], scaled - index);
}

export function rampGradient(stops: Ramp): string {
  return `linear-gradient(to right, ${stops.map(css).join(", ")})`;
}
