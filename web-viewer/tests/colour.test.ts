import assert from "node:assert/strict";
import { test } from "node:test";
import { groupColour, materialColour, palette } from "../src/colour/palette";
import { AutoRange, niceAbove } from "../src/colour/range";
import * as ramps from "../src/colour/ramp";
import { rampColour, speedRamp } from "../src/colour/ramp";
import { css, hexToRgb } from "../src/colour/rgb";
import type { Rgb } from "../src/colour/rgb";
import { defaultMode, modes, quantityOf } from "../src/model/quantities";

test("values are rounded up to 1, 2, 3 or 5 times a power of ten", () => {
  const cases = [
    [0.9, 1],
    [1, 1],
    [1.1, 2],
    [2.5, 3],
    [4, 5],
    [7, 10],
    [0.031, 0.05],
    [1234, 2000],
  ] as const;
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

// How people see linear RGB (Machado, Oliveira and Fernandes 2009, complete deficiency).
const vision = {
  "full colour vision": [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  protanopia: [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  deuteranopia: [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
};

/** L*, a* and b* of a colour; L* is the lightness, from 0 to 100. */
function labOf(colour: Rgb, seen: number[][]): [number, number, number] {
  const linear = colour.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
  const [r = 0, g = 0, b = 0] = seen.map((row) => row.reduce((sum, weight, k) => sum + weight * (linear[k] ?? 0), 0));
  const [x, y, z] = [
    (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
    0.2126 * r + 0.7152 * g + 0.0722 * b,
    (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
  ].map((part) => (part > 0.008856 ? Math.cbrt(part) : (903.3 * Math.max(0, part) + 16) / 116)) as [
    number,
    number,
    number,
  ];
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

test("the lightness of every ramp rises clearly from stop to stop, for colour-blind people too", () => {
  const used = modes.flatMap((mode) => quantityOf(mode).scale?.ramp ?? []);
  const all = Object.entries(ramps).filter(([name]) => name.endsWith("Ramp"));
  assert.equal(used.length / 6, all.length);
  for (const [name, stops] of all as [string, ramps.Ramp][]) {
    for (const [kind, seen] of Object.entries(vision)) {
      const steps = Array.from({ length: 21 }, (_, k) => labOf(rampColour(stops, k / 20), seen)[0]);
      for (let k = 4; k <= 20; k += 4) {
        const rise = (steps[k] ?? 0) - (steps[k - 4] ?? 0);
        assert.ok(rise >= 6, `${name}, ${kind}: rises by ${rise.toFixed(1)} before stop ${k / 4}`);
      }
      const falls = steps.findIndex((step, k) => k > 0 && step <= (steps[k - 1] ?? 0));
      assert.equal(falls, -1, `${name}, ${kind}: falls at ${falls / 20}`);
    }
  }
});

test("colours of groups and materials are different, for colour-blind people too", () => {
  const colours = palette.map((_, index) => materialColour(index));
  for (const [kind, seen] of Object.entries(vision)) {
    const places = colours.map((colour) => labOf(colour, seen));
    places.forEach((one, i) => {
      places.slice(i + 1).forEach((other, k) => {
        const difference = Math.hypot(...one.map((part, axis) => part - (other[axis] ?? 0)));
        assert.ok(difference > 20, `${kind}: ${difference.toFixed(1)} between ${palette[i]} and ${palette[i + 1 + k]}`);
      });
    });
  }
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
