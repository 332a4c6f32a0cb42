import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Drop } from "../src/connection/commands";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { factsOf } from "../src/model/facts";
import type { Vec3 } from "../src/model/facts";
import { dropCountFor, dropFor, dropRadiusFor, dropRadiusRule, gravityPresetOf, impulseRule } from "../src/ui/presets";

function factsWith(radius: number, side: number) {
  const places = radius > 0 ? { count: 2, radius } : {};
  const bounds = { boundsMin: [0, 0, 0], boundsMax: [3 * side, 2 * side, side] };
  return factsOf(create(SceneFactsSchema, { ...bounds, ...places }));
}

test("spheres to drop fit the scene: they have its mean radius, or one that fits its bounds", () => {
  assert.equal(dropRadiusFor(factsWith(0.02, 1)), 0.02);
  assert.equal(dropRadiusFor(factsWith(0, 0.01)), 0.000115);
  assert.equal(dropRadiusFor(factsWith(0, 800)), 9);
  assert.equal(dropRadiusFor(factsWith(0.9, 1)), 0.23);
  assert.deepEqual(dropRadiusRule(factsWith(0.02, 1)), { unit: "m", least: 1e-6, most: 0.23 });
});

test("the box for dropped spheres has room for the largest that are allowed", () => {
  const facts = factsWith(0, 1);
  for (const radius of [0.001, 0.1, dropRadiusRule(facts).most ?? NaN]) {
    const { min, max } = dropFor(facts, 1, radius);
    const sides = max.map((high, axis) => high - (min[axis] ?? NaN));
    assert.ok(Math.min(...sides) >= 2 * radius, `radius ${radius}: sides ${sides.join(" ")}`);
    assert.ok(Math.min(...min) >= radius && max.every((high, axis) => high <= 3 - axis - radius));
  }
});

test("an impulse is limited once the server has told its limit", () => {
  assert.deepEqual(impulseRule({ maxImpulse: 1608.5 }), { unit: "N s", above: 0, most: 100 });
  assert.equal(impulseRule({ maxImpulse: 0 }).most, undefined);
  assert.equal(impulseRule(undefined).most, undefined);
});

test("a gravity preset is recognised by its values", () => {
  assert.equal(gravityPresetOf([0, 0, -1.62]), "Moon");
  assert.equal(gravityPresetOf([0, 0, -1.7]), "Custom");
});

test("spheres are dropped in the upper third of the bounds, or in a part that is high enough for them", () => {
  const rapids = { min: [0, 0, 0] as Vec3, max: [9.6, 3.6, 1.8] as Vec3 };
  const heights = ({ min, max }: Drop): [number, number] => [min[2] ?? NaN, max[2] ?? NaN];
  const [low, high] = heights(dropFor(rapids, 200, 0.06));
  assert.ok(low > 1.1 && high < 1.8, `from ${low} to ${high} m`);
  assert.equal(dropCountFor(rapids, 0.06), 200);
  const box = { min: [-1, -1, 0] as Vec3, max: [1, 1, 1.5] as Vec3 };
  const [bottom, top] = heights(dropFor(box, 1, 0.3));
  assert.ok(top - bottom > 0.6, "higher than a sphere");
  assert.ok(dropCountFor(box, 0.3) < 5, "200 would be refused");
  assert.equal(dropCountFor(box, 0.9), 1);
});
