import { contactsRamp, energyRamp, heightRamp, idRamp, overlapRamp, radiusRamp, speedRamp } from "../colour/ramp";
import type { Ramp } from "../colour/ramp";
import type { Rgb } from "../colour/rgb";
import { count, figure, length, percent, withPrefix } from "../format";
import { Quantity as Sent } from "../gen/spherule/v1/frame_pb";
import type { Facts } from "./facts";
import { heightOf, sentValue, shownSpeed, speedOf } from "./positions";
import type { Shown } from "./states";

export type Range = [number, number];

/**
 * A colour scale. Its range is constant in a scene, or automatic: then it begins at 0, and its end follows the values
 * that are shown, but is at least `least`. A value that is NaN is unknown. `unit`: in which users give the ends.
 * `size`: the size of this unit, if it is not 1.
 */
export type Scale = { ramp: Ramp; unit: string; size?: number } & (
  { range(facts: Facts): Range } | { value(facts: Facts, shown: Shown, place: number): number; least: number }
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
  glsl: string; // expression: the colour (vec3, sRGB), see shaders/colour.glsl
  scale?: Scale;
  sent?: Sent; // the quantity of frames that the mode needs
  legend(facts: Facts, range: Range): LegendContent;
  /** A line of the inspector. */
  describe?(facts: Facts, shown: Shown, place: number): string;
}

const entriesShown = 6; // in a legend
const negligible = 0.01; // error of a speed, as a share of it

/** A legend of the first of these groups or materials. `unknown`: said if there are none. */
function listOf(entries: readonly { colour: Rgb; name: string; count: number }[], unknown: string): LegendContent {
  const swatches = entries.slice(0, entriesShown).map((one) => ({ ...one, figure: count(one.count) }));
  const more = entries.length - swatches.length;
  const notes = more > 0 ? [`and ${more} more`] : [];
  return { swatches, notes: entries.length > 0 ? notes : [unknown] };
}

/** The values of a quantity that the server sends, for a scale. */
function sent(quantity: Sent): (facts: Facts, shown: Shown, place: number) => number {
  return (_, shown, place) => sentValue(quantity, shown, place);
}

/** All quantities, in the order of the colour modes and of the inspector's lines. */
export const quantities = {
  speed: {
    label: "Speed",
    glsl: "colourOf(speedNow(place))",
    scale: { ramp: speedRamp, unit: "m/s", value: speedOf, least: 0.1 },
    sent: Sent.SPEED,
    legend: (_, [low, high]) => ({ bar: speedRamp, low: figure(low), high: `${figure(high)} m/s` }),
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
    glsl: "colourOf(radiusOf(place))",
    scale: { ramp: radiusRamp, unit: "m", range: ({ population }) => population.radiusRange },
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
    glsl: "colourOf(idOf(place))",
    scale: { ramp: idRamp, unit: "", range: ({ population }) => population.idRange },
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
    legend: ({ population }) => listOf(population.groups, "this scene has no groups"),
  },
  contacts: {
    label: "Contacts",
    glsl: "sentColour(place)",
    scale: { ramp: contactsRamp, unit: "", value: sent(Sent.CONTACTS), least: 5 },
    sent: Sent.CONTACTS,
    legend: (_, [low, high]) => ({ bar: contactsRamp, low: figure(low), high: `${figure(high)} bodies` }),
  },
  overlap: {
    label: "Overlap",
    glsl: "sentColour(place)",
    scale: { ramp: overlapRamp, unit: "%", size: 0.01, value: sent(Sent.OVERLAP), least: 0.001 },
    sent: Sent.OVERLAP,
    legend: (_, [low, high]) => ({ bar: overlapRamp, low: percent(low), high: `${percent(high)} of the radius` }),
  },
  energy: {
    label: "Energy",
    glsl: "sentColour(place)",
    scale: { ramp: energyRamp, unit: "J", value: sent(Sent.ENERGY), least: 1e-12 },
    sent: Sent.ENERGY,
    legend: (_, [low, high]) => ({ bar: energyRamp, low: withPrefix(low, "J"), high: withPrefix(high, "J") }),
  },
  height: {
    label: "Height",
    glsl: "colourOf(position.z - u_bottom)",
    scale: { ramp: heightRamp, unit: "m", value: heightOf, least: 1e-9 },
    legend: (_, [low, high]) => ({ bar: heightRamp, low: length(low), high: length(high) }),
  },
  material: {
    label: "Material",
    glsl: "lookOf(place).material",
    legend: ({ population }) => listOf(population.materials, "no spheres whose material is known"),
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
