import assert from "node:assert/strict";
import { test } from "node:test";
import { groupColour } from "../src/colour/groups";
import { AutoRange, niceAbove } from "../src/colour/range";
import { rampColour, speedRamp } from "../src/colour/ramp";
import { css, hexToRgb } from "../src/colour/rgb";
import { defaultMode } from "../src/model/quantities";

test("values are rounded up to 1, 2, 3 or 5 times a power of ten", () => {
  const cases = [[0.9, 1], [1, 1], [1.1, 2], [2.5, 3], [4, 5], [7, 10], [0.031, 0.05], [1234, 2000]] as const;
  for (const [value, nice] of cases) {
    assert.ok(Math.abs(niceAbove(value) / nice - 1) < 1e-9, `${value}: ${niceAbove(value)}`);
  }
  assert.equal(niceAbove(0), 0);
  assert.equal(niceAbove(NaN), 0);
});

test("a range rises at once, and falls only after a time of smaller values, to their maximum", () => {
  const range = new AutoRange(0.1, 1000);
  range.update(4, 0);
  assert.equal(range.high, 5);
  range.update(1.5, 100);
  range.update(0.3, 900);
  assert.equal(range.high, 5);
  range.update(0.3, 1100);
  assert.equal(range.high, 2);
});

test("a large value restarts that time", () => {
  const range = new AutoRange(0.1, 1000);
  range.update(4, 0);
  range.update(0.3, 100);
  range.update(4, 900);
  range.update(0.3, 1200);
  assert.equal(range.high, 5);
});

test("a locked range does not change, and a range never falls below its minimum", () => {
  const range = new AutoRange(0.1, 0);
  range.locked = true;
  range.update(50, 0);
  range.reset();
  assert.equal(range.high, 0.1);
  range.locked = false;
  range.update(1e-9, 0);
  assert.equal(range.high, 0.1);
});

test("a ramp interpolates between its stops, and is constant beyond its ends", () => {
  assert.equal(css(rampColour(speedRamp, 0)), css(speedRamp[0]));
  assert.equal(css(rampColour(speedRamp, 0.2)), css(speedRamp[1]));
  assert.equal(css(rampColour(speedRamp, 7)), css(speedRamp[5]));
  const between = rampColour(speedRamp, 0.1);
  assert.ok(Math.abs(between[0] - (speedRamp[0][0] + speedRamp[1][0]) / 2) < 1e-9);
});

test("colours are parsed from six hexadecimal digits only", () => {
  assert.deepEqual(hexToRgb("#ff0080"), [1, 0, 128 / 255]);
  for (const wrong of ["", "red", "#fff", "#12345g", "#1234567"]) assert.equal(hexToRgb(wrong), undefined);
});

test("a scene whose groups have colours is coloured by group, others by speed", () => {
  assert.equal(defaultMode([{ own: true }, { own: true }]), "group");
  assert.equal(defaultMode([{ own: true }]), "speed");
  assert.equal(defaultMode([{ own: false }, { own: false }]), "speed");
});

test("a group keeps its own colour; others get different ones", () => {
  assert.deepEqual(groupColour("#ff0000", 0), { colour: [1, 0, 0], own: true });
  const [one, two] = [groupColour("", 1), groupColour("", 2)];
  assert.deepEqual([one.own, two.own], [false, false]);
  assert.notDeepEqual(one.colour, two.colour);
});
