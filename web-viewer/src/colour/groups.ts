import { hexToRgb } from "./rgb";
import type { Rgb } from "./rgb";

/** Colours of groups to which the scene gives none: muted, different in hue and lightness. */
const palette = ["#5b86b5", "#d98a5b", "#6fa78a", "#c7b35a", "#9a7fb0", "#c96f74", "#5fa7b0", "#8d8a80"];

/** Returns the colour of a group. `hex`: given by the scene, or empty; then `own` is false. */
export function groupColour(hex: string, index: number): { colour: Rgb; own: boolean } {
  const own = hexToRgb(hex);
  return { colour: own ?? paletteColour(index), own: own !== undefined };
}

function paletteColour(index: number): Rgb {
  return hexToRgb(palette[index % palette.length] ?? "") ?? [0.5, 0.5, 0.5];
}
