import { create } from "@bufbuild/protobuf";
import type { JsonObject } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { ScenePartsSchema } from "../src/gen/spherule/v1/scene_parts_pb";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { factsOf } from "../src/model/facts";
import { problemOf, withValue } from "../src/scene_parts/part_values";
import { kinds } from "../src/scene_parts/part_kinds";

const facts = factsOf(
  create(SceneFactsSchema, {
    boundsMin: [-1, -1, 0],
    boundsMax: [1, 1, 2],
    groups: [{ name: "floor", colour: "#ff0080", material: 1, roughness: 0.2, metal: 0 }],
    materials: ["steel", "cork"],
    radius: 0.04,
  }),
);
const parts = create(ScenePartsSchema, {
  fields: [{ kind: { case: "drag", value: { density: 5, velocity: [1, 2, 3] } } }],
  emitters: [{ name: "rain", flow: { case: "rate", value: 7 }, total: 12n }],
  materials: [{ name: "steel" }, { name: "cork", density: 240 }],
  pairs: [{ a: "steel", b: "cork", friction: 0.5 }],
});
const known = { parts, facts };

test("parts are shown as scene files have them, and are sent as they are shown", () => {
  const shown = kinds.map((kind) => kind.parts(known)[0]);
  assert.deepEqual(shown, [
    { drag: { density: 5, velocity: [1, 2, 3] } },
    { name: "rain", rate: 7, total: "12" },
    { name: "steel" },
    { a: "steel", b: "cork", friction: 0.5 },
    { name: "floor", colour: "#ff0080", material: "cork", roughness: 0.2, metal: 0 },
  ]);
  const sent = kinds.map((kind, k) => kind.change(3, shown[k] as JsonObject, {}).case);
  assert.deepEqual(sent, ["changeField", "changeEmitter", "changeMaterial", "setPair", "changeGroup"]);
});

test("a change of a group has the changed values alone", () => {
  const groups = kinds.find(({ id }) => id === "group");
  assert.ok(groups);
  const [shown] = groups.parts(known);
  assert.ok(shown);
  const sent = (part: JsonObject): unknown => {
    const { roughness, metal, name, material, colour } = groups.change(3, part, shown).value as Record<string, unknown>;
    return { roughness, metal, name, material, colour };
  };
  const none = { roughness: undefined, metal: undefined, name: undefined, material: undefined, colour: undefined };
  assert.deepEqual(sent(withValue(shown, ["metal"], 0.5)), { ...none, metal: 0.5 });
  assert.deepEqual(sent({ ...shown, name: "bed", colour: "" }), { ...none, name: "bed", colour: "" });
  assert.deepEqual(sent(shown), none);
  assert.throws(() => groups.change(3, [1], shown));
});

test("a new pair is one of materials with names", () => {
  const pairs = kinds.find(({ id }) => id === "pair");
  assert.ok(pairs);
  const withMaterials = (...names: string[]): typeof known => ({
    parts: create(ScenePartsSchema, { materials: names.map((name) => ({ name })) }),
    facts,
  });
  const made = (...names: string[]): JsonObject | undefined => pairs.templates.Pair?.(withMaterials(...names));
  assert.deepEqual(made("", "steel", "cork", ""), { a: "steel", b: "cork", friction: 0.3 });
  assert.deepEqual(made("", "cork"), { a: "cork", b: "cork", friction: 0.3 });
  assert.equal(pairs.missing?.(withMaterials("", "cork")), "");
  assert.notEqual(pairs.missing(withMaterials("")), "");
});

test("every template is a part that can be sent", () => {
  for (const kind of kinds) {
    for (const [name, template] of Object.entries(kind.templates)) {
      const part = template(known);
      assert.ok(kind.add?.(part).value, name);
      assert.notEqual(kind.name(part), "", name);
    }
  }
});

test("a value is put into a copy of the part", () => {
  const part = { drag: { density: 1, velocity: [0, 0, 0] }, inSphere: { radius: 1 } };
  const changed = withValue(part, ["drag", "velocity"], [1, 2, 3]);
  assert.deepEqual(changed, { drag: { density: 1, velocity: [1, 2, 3] }, inSphere: { radius: 1 } });
  assert.deepEqual(part.drag.velocity, [0, 0, 0]);
});

test("a refusal is told without the command that it belongs to", () => {
  const told = (field: string): string =>
    problemOf({ case: "refused", value: { field, reason: "is bad" } } as Parameters<typeof problemOf>[0]);
  assert.equal(told("addField.field.drag.density"), "drag.density is bad.");
  assert.equal(told("removeMaterial.number"), "Is bad.");
  assert.equal(told("changeGroup.colour"), "colour is bad.");
  assert.equal(told(""), "Is bad.");
  assert.notEqual(problemOf({ case: "lost" }), "");
});
