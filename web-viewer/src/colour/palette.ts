import { hexToRgb } from "./rgb";
import type { Rgb } from "./rgb";

/** Colours of groups and materials: muted, and different for colour-blind people, too (tests/colour.test.ts). */
export const palette = ["#5b9add", "#b16d42", "#37a286", "#c9b35d", "#515a90", "#904545", "#9dd4d7", "#289ba9"];

const grey: Rgb = [0.63, 0.63, 0.63];

/** Returns the colour of a group. `hex`: given by the scene, or empty; then `own` is false. */
export function groupColour(hex: string, index: number): { colour: Rgb; own: boolean } {
  const own = hexToRgb(hex);
  return { colour: own ?? paletteColour(index), own: own !== undefined };
}

/** Returns the colour of a material. `index`: its number in the scene; undefined if the server does not tell it. */
export function materialColour(index: number | undefined): Rgb {
  return index === undefined ? grey : paletteColour(index);
}

function paletteColour(index: number): Rgb {
  return hexToRgb(palette[index % palette.length] ?? "") ?? grey;
}
