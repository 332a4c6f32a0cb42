import { idRamp, radiusRamp, speedRamp } from "../colour/ramp";
import type { Ramp } from "../colour/ramp";
import type { Rgb } from "../colour/rgb";
import { count, figure, length } from "../format";
import type { Facts } from "./facts";
import { shownSpeed, speedOf } from "./positions";
import type { Shown } from "./states";

export type Range = [number, number];

/**
 * A colour scale. Its range is constant in a scene, or automatic: then it begins at 0, and its end follows the values
 * that are shown, but is at least `least`. A value that is NaN is unknown.
 */
export type Scale = { ramp: Ramp } & (
  | { range(facts: Facts): Range }
  | { value(facts: Facts, shown: Shown, place: number): number; least: number }
);

export interface Swatch {
  colour: Rgb;
  name: string;
  figure: string;
}

/** The content of a legend: a bar with the texts of its ends, or swatches and lines of text. */
export type LegendContent = { bar: Ramp; low: string; high: string } | { swatches: Swatch[]; notes: string[] };

/** A per-sphere quantity that the page shows: by a colour mode with its legend, and in the inspector. */
export interface Quantity {
  label: string; // of the colour mode
  /** GLSL expression: the value (float) if there is a scale, else the colour (vec3, sRGB). See shaders/colour.glsl. */
  glsl: string;
  scale?: Scale;
  legend(facts: Facts, range: Range): LegendContent;
  /** A line of the inspector. */
  describe?(facts: Facts, shown: Shown, place: number): string;
}

const groupsShown = 6; // in the legend
const negligible = 0.01; // error of a speed, as a share of it

/** All quantities, in the order of the colour modes and of the inspector's lines. */
export const quantities = {
  speed: {
    label: "Speed",
    glsl: "speedNow(place)",
    scale: { ramp: speedRamp, value: speedOf, least: 0.1 },
    legend: (_, [, high]) => ({ bar: speedRamp, low: "0", high: `${figure(high)} m/s` }),
    describe: (facts, shown, place) => {
      const known = shownSpeed(facts, shown, place);
      if (!known) return "speed unknown";
      const { speed, error } = known;
      if (error <= negligible * speed) return `${figure(speed)} m/s`;
      if (error >= speed) return `under ${figure(speed + error)} m/s`;
      return `${figure(speed - error)} to ${figure(speed + error)} m/s`;
    },
  },
  radius: {
    label: "Radius",
    glsl: "radiusOf(place)",
    scale: { ramp: radiusRamp, range: ({ population }) => population.radiusRange },
    legend: (_, [low, high]) => {
      if (low < high) return { bar: radiusRamp, low: length(low), high: length(high) };
      return { swatches: [{ colour: radiusRamp[0], name: `all ${length(low)}`, figure: "" }], notes: [] };
    },
    describe: ({ population }, _, place) => {
      const group = population.groupOf(place);
      return `radius ${length(population.radiusOf(place))}${group ? `, ${group.name}` : ""}`;
    },
  },
  id: {
    label: "Id",
    glsl: "idOf(place)",
    scale: { ramp: idRamp, range: ({ population }) => population.idRange },
    legend: (_, [low, high]) => ({ bar: idRamp, low: count(low), high: count(high) }),
  },
  cell: {
    label: "Grid cell",
    glsl: "cellColour(position)",
    legend: ({ cellSize, cells }) => {
      if (cellSize <= 0) return { swatches: [], notes: ["this scene has no grid"] };
      const notes = [`one colour per cell of ${length(cellSize)}`, `${cells.map(count).join(" × ")} cells`];
      return { swatches: [], notes };
    },
  },
  group: {
    label: "Group",
    glsl: "lookOf(place).colour",
    legend: ({ population: { groups } }) => {
      const shown = groups.slice(0, groupsShown);
      const more = groups.length - shown.length;
      const swatches = shown.map((group) => ({ colour: group.colour, name: group.name, figure: count(group.count) }));
      return { swatches, notes: more > 0 ? [`and ${more} more`] : [] };
    },
  },
} satisfies Record<string, Quantity>;

/** A colour mode. */
export type Mode = keyof typeof quantities;

export const modes = Object.keys(quantities) as Mode[];

export function quantityOf(mode: Mode): Quantity {
  return quantities[mode];
}

/** The default mode of a scene: "group" if at least two of its groups have a colour of their own, else "speed". */
export function defaultMode(groups: readonly { own: boolean }[]): Mode {
  return groups.filter((group) => group.own).length > 1 ? "group" : "speed";
}
