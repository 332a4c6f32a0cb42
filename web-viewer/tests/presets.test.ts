import assert from "node:assert/strict";
import { test } from "node:test";
import { gravityPresetOf } from "../src/ui/presets";

test("a gravity preset is recognised by its values", () => {
  assert.equal(gravityPresetOf([0, 0, -1.62]), "Moon");
  assert.equal(gravityPresetOf([0, 0, -1.7]), "Custom");
});
