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
  const sent = kinds.map((kind, k) => kind.change(3, shown[k] as JsonObject).case);
  assert.deepEqual(sent, ["changeField", "changeEmitter", "changeMaterial", "setPair", "changeGroup"]);
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
