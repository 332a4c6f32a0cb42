import assert from "node:assert/strict";
import { test } from "node:test";
import { ladder, RenderQualityControl } from "../src/renderer/render_quality";

test("quality decreases after several slow images, and only then", () => {
  const control = new RenderQualityControl("auto", false);
  for (let i = 0; i < 100; i++) control.took(i % 3 ? 16 : 50);
  assert.equal(control.quality, ladder[0]);
  for (let i = 0; i < 17; i++) control.took(50);
  assert.equal(control.quality, ladder[1]);
});

test("a chosen quality is kept, and a software renderer starts with light quality", () => {
  const control = new RenderQualityControl("full", true);
  for (let i = 0; i < 200; i++) control.took(500);
  assert.equal(control.quality, ladder[0]);
  assert.equal(new RenderQualityControl("auto", true).quality.full, false);
});
