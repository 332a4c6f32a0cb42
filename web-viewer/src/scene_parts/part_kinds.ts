import { fromJson, toJson } from "@bufbuild/protobuf";
import type { JsonObject, JsonValue } from "@bufbuild/protobuf";
import type { CommandKind } from "../connection/link";
import { ChangeGroupSchema } from "../gen/spherule/v1/scene_parts_pb";
import type { SceneParts } from "../gen/spherule/v1/scene_parts_pb";
import { EmitterSchema } from "../gen/spherule/v1/emitter_pb";
import { FieldSchema } from "../gen/spherule/v1/fields_pb";
import { MaterialPairSchema, MaterialSchema } from "../gen/spherule/v1/scene_pb";
import type { Facts } from "../model/facts";
import { changesOf } from "./part_values";

/** A value of a part with an entry of its own: numbers, or a text. `path`: in the JSON of the part. */
export interface Value {
  path: string[];
  label: string;
  text?: boolean;
}

/** The state from which the lists follow. */
export interface Known {
  parts: SceneParts;
  facts: Facts;
}

/** A kind of parts of a scene. A part is shown, and changed, as the JSON that a scene file has. */
export interface PartKind {
  id: string;
  title: string;
  one: string; // a part of the kind, for reports
  values: Value[];
  parts(known: Known): JsonObject[];
  name(part: JsonObject): string;
  templates: Record<string, (known: Known) => JsonObject>;
  /** Why there is no part for the templates; empty if there is. */
  missing?(known: Known): string;
  add?(part: JsonValue): CommandKind;
  /** `shown`: the part as the user saw it before the change. */
  change(number: number, part: JsonValue, shown: JsonObject): CommandKind;
  remove(number: number, part: JsonObject): CommandKind;
}

const round = (value: number): number => Number(value.toPrecision(3));

/** A point of the bounds, by shares of their sides. */
function at({ facts: { min, max } }: Known, x: number, y: number, z: number): number[] {
  const along = (low: number, high: number, share: number): number => round(low + share * (high - low));
  return [along(min[0], max[0], x), along(min[1], max[1], y), along(min[2], max[2], z)];
}

function size({ facts: { min, max } }: Known): number {
  return Math.min(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
}

function radius({ facts }: Known): number {
  const { radius: typical } = facts.population;
  return round(typical > 0 ? typical : 0.05);
}

/** A name that no part has, such as "material 3". */
function freeName(parts: { name: string }[], word: string): string {
  for (let number = parts.length + 1; ; number += 1) {
    const name = `${word} ${number}`;
    if (parts.every((part) => part.name !== name)) return name;
  }
}

const fields: PartKind = {
  id: "field",
  title: "Fields",
  one: "Field",
  values: [
    { path: ["drag", "velocity"], label: "Wind, m/s" },
    { path: ["drag", "density"], label: "Density, kg/m³" },
    { path: ["attraction", "strength"], label: "Strength, m³/s²" },
    { path: ["attraction", "centre"], label: "Centre, m" },
    { path: ["buoyancy", "density"], label: "Density, kg/m³" },
    { path: ["buoyancy", "surface"], label: "Surface, m" },
    { path: ["spring", "stiffness"], label: "Stiffness, N/m" },
    { path: ["spring", "damping"], label: "Damping, N s/m" },
    { path: ["spring", "centre"], label: "Centre, m" },
  ],
  parts: ({ parts }) => parts.fields.map((field) => toJson(FieldSchema, field) as JsonObject),
  name: (part) => {
    const { drag } = part as { drag?: JsonObject };
    if (!drag) return Object.keys(part).find((key) => !key.startsWith("in")) ?? "field";
    return drag.vortex ? "vortex" : drag.velocity ? "wind" : "drag";
  },
  templates: {
    Wind: () => ({ drag: { density: 1.2, velocity: [3, 0, 0] } }),
    "Air at rest": () => ({ drag: { density: 1.2 } }),
    Vortex: (known) => ({
      drag: { vortex: { centre: at(known, 0.5, 0.5, 0), axis: [0, 0, 1], speed: 3, core: round(size(known) / 4) } },
    }),
    Attraction: (known) => ({
      attraction: {
        centre: at(known, 0.5, 0.5, 0.5),
        strength: round(5 * size(known) ** 2),
        softening: round(size(known) / 4),
      },
    }),
    Water: (known) => ({ buoyancy: { density: 1000, surface: at(known, 0.5, 0.5, 0.5) } }),
    Spring: (known) => ({ spring: { centre: at(known, 0.5, 0.5, 0.5), stiffness: 1, damping: 0.1 } }),
  },
  add: (part) => ({ case: "addField", value: { field: fromJson(FieldSchema, part) } }),
  change: (number, part) => ({ case: "changeField", value: { number, field: fromJson(FieldSchema, part) } }),
  remove: (number) => ({ case: "removeField", value: { number } }),
};

const emitters: PartKind = {
  id: "emitter",
  title: "Emitters",
  one: "Emitter",
  values: [
    { path: ["rate"], label: "Rate, 1/s" },
    { path: ["massFlow"], label: "Flow, kg/s" },
    { path: ["radius", "constant"], label: "Radius, m" },
    { path: ["velocity"], label: "Velocity, m/s" },
    { path: ["material"], label: "Material", text: true },
  ],
  parts: ({ parts }) => parts.emitters.map((emitter) => toJson(EmitterSchema, emitter) as JsonObject),
  name: (part) => (part.name as string | undefined) ?? "emitter",
  templates: {
    Rain: (known) => ({
      name: freeName(known.parts.emitters, "rain"),
      box: { min: at(known, 0.1, 0.1, 0.85), max: at(known, 0.9, 0.9, 0.95) },
      rate: 20,
      radius: { constant: radius(known) },
    }),
    Fountain: (known) => ({
      name: freeName(known.parts.emitters, "fountain"),
      disc: { centre: at(known, 0.5, 0.5, 0.3), normal: [0, 0, 1], radius: round(4 * radius(known)) },
      rate: 10,
      radius: { constant: radius(known) },
      velocity: [0, 0, round(Math.sqrt(10 * size(known)))],
      velocitySpread: 0.2,
    }),
  },
  add: (part) => ({ case: "addEmitter", value: { emitter: fromJson(EmitterSchema, part) } }),
  change: (number, part) => ({ case: "changeEmitter", value: { number, emitter: fromJson(EmitterSchema, part) } }),
  remove: (number) => ({ case: "removeEmitter", value: { number } }),
};

const materials: PartKind = {
  id: "material",
  title: "Materials",
  one: "Material",
  values: [
    { path: ["density"], label: "Density, kg/m³" },
    { path: ["friction"], label: "Friction" },
    { path: ["restitution"], label: "Restitution" },
    { path: ["rollingResistance"], label: "Rolling" },
  ],
  parts: ({ parts }) => parts.materials.map((material) => toJson(MaterialSchema, material) as JsonObject),
  name: (part) => (part.name as string | undefined) ?? "first material",
  templates: {
    Material: ({ parts }) => ({
      name: freeName(parts.materials, "material"),
      density: 1000,
      friction: 0.3,
      restitution: 0.5,
    }),
    Rubber: ({ parts }) => ({
      name: freeName(parts.materials, "rubber"),
      density: 1100,
      friction: 0.9,
      restitution: 0.8,
    }),
  },
  add: (part) => ({ case: "addMaterial", value: { material: fromJson(MaterialSchema, part) } }),
  change: (number, part) => ({ case: "changeMaterial", value: { number, material: fromJson(MaterialSchema, part) } }),
  remove: (number) => ({ case: "removeMaterial", value: { number } }),
};

const namesOf = (parts: { name: string }[]): string[] => parts.map(({ name }) => name).filter(Boolean);

const pair = (part: JsonValue): CommandKind => ({
  case: "setPair",
  value: { pair: fromJson(MaterialPairSchema, part) },
});

const pairs: PartKind = {
  id: "pair",
  title: "Pairs of materials",
  one: "Pair",
  values: [
    { path: ["friction"], label: "Friction" },
    { path: ["restitution"], label: "Restitution" },
  ],
  parts: ({ parts }) => parts.pairs.map((one) => toJson(MaterialPairSchema, one) as JsonObject),
  name: ({ a, b }) => `${a as string} and ${b as string}`,
  templates: {
    Pair: ({ parts }) => {
      const names = namesOf(parts.materials);
      return { a: names.at(0) ?? "", b: names.at(-1) ?? "", friction: 0.3 };
    },
  },
  missing: ({ parts }) => (namesOf(parts.materials).length > 0 ? "" : "No material has a name: give one a name first."),
  add: pair,
  change: (_, part) => pair(part),
  remove: (_, { a = "", b = "" }) => pair({ a, b }),
};

const groups: PartKind = {
  id: "group",
  title: "Groups",
  one: "Group",
  values: [
    { path: ["name"], label: "Name", text: true },
    { path: ["colour"], label: "Colour", text: true },
    { path: ["material"], label: "Material", text: true },
    { path: ["roughness"], label: "Roughness" },
    { path: ["metal"], label: "Metal" },
  ],
  parts: ({ parts, facts }) =>
    facts.population.groups.map(({ name, colour, own, material = 0, roughness, metal }) => ({
      name,
      colour: own
        ? `#${colour
            .map((part) =>
              Math.round(255 * part)
                .toString(16)
                .padStart(2, "0"),
            )
            .join("")}`
        : "",
      material: parts.materials[material]?.name ?? "",
      roughness: round(roughness),
      metal: round(metal),
    })),
  name: (part) => part.name as string,
  templates: {},
  // Values that are not sent stay as they are, also those that another user changes meanwhile.
  change: (number, part, shown) => ({
    case: "changeGroup",
    value: { ...fromJson(ChangeGroupSchema, changesOf(part, shown)), number },
  }),
  remove: (number) => ({ case: "removeGroup", value: { number } }),
};

export const kinds: readonly PartKind[] = [fields, emitters, materials, pairs, groups];
