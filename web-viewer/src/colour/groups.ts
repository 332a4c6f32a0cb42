import type { GroupFacts } from "../gen/spherule/v1/control_pb";
import type { Group } from "../scene/facts";
import { hexToRgb } from "./rgb";
import type { Rgb } from "./rgb";

/** For groups that bring no colour: calm, apart in hue and lightness. */
const palette = ["#5b86b5", "#d98a5b", "#6fa78a", "#c7b35a", "#9a7fb0", "#c96f74", "#5fa7b0", "#8d8a80"];

export function groupColours(groups: GroupFacts[]): Group[] {
  return groups.map((group, index) => {
    const own = hexToRgb(group.colour);
    return {
      name: group.name || `group ${index + 1}`,
      first: group.first,
      count: group.count,
      colour: own ?? paletteColour(index),
      own: own !== undefined,
    };
  });
}

function paletteColour(index: number): Rgb {
  return hexToRgb(palette[index % palette.length] ?? "") ?? [0.5, 0.5, 0.5];
}
