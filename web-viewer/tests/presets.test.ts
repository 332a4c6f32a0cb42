import assert from "node:assert/strict";
import { test } from "node:test";
import type { Drop } from "../src/connection/commands";
import type { Vec3 } from "../src/model/facts";
import { dropCountFor, dropFor, gravityPresetOf } from "../src/ui/presets";

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
