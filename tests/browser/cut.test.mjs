// Groups and parts of the scene that images leave out.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { control, evaluateLarge, open, ticks, unfold, when } from "./support/browser.mjs";
import { cluster, compare, placesSeen } from "./support/rays.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const at = 1e4; // m, on each axis: the middle of the scene
const spheres = cluster({ least: 0.05, ratio: 10, count: 40 }).map(({ position, radius }) => ({
  position: position.map((x) => at + x),
  radius,
}));
const even = spheres.filter((_, k) => k % 2 === 0);
const odd = spheres.filter((_, k) => k % 2 === 1);
const places = [...even, ...odd];
const scene = {
  gravity: [0, 0, 0],
  bounds: { min: [at - 1, at - 1, at - 1], max: [at + 1, at + 1, at + 1] },
  groups: [
    { name: "even", list: { spheres: even } },
    { name: "odd", list: { spheres: odd } },
  ],
  camera: { eye: [at + 3, at - 3, at + 2], target: [at, at, at] },
};

let server;
let page;
const suite = browserSuite(async (browser) => {
  const file = path.join(suite.folder, "cluster.json");
  writeFileSync(file, JSON.stringify(scene));
  server = await serve(file);
  page = await open(browser, `${server.url}?tier=fine`, {
    size: [800, 600],
    deviceScaleFactor: 0.5,
    reducedMotion: "reduce",
  });
  await page.keyboard.press(" ");
  await when(page, () => spherule.session.paused);
  await unfold(page, "Show");
});

/** Compares a small image, over which nothing lies, with the expected one. `seen`: a filter of places. */
async function check(kept, keys, seen = () => true) {
  await page.setViewportSize({ width: 240, height: 136 });
  await page.evaluate(() => (document.querySelector(".page").style.display = "none"));
  await ticks(page, 6); // with reduced motion, the picture is in its place then
  let [different, pixels] = [0, 0];
  for (const key of ["", ...keys]) {
    if (key) await page.keyboard.press(key);
    await ticks(page, 3);
    const { camera, drawn } = await evaluateLarge(page, () => ({ camera: spherule.camera, drawn: spherule.places }));
    const hidden = (sphere, place) => (seen(place) ? sphere : { ...sphere, radius: 0 });
    const expected = placesSeen(camera, places.map(hidden), drawn.width, drawn.height, kept);
    const { differ, wrong } = compare(drawn, expected);
    assert.deepEqual(wrong, [], `after ${key}`);
    assert.ok(drawn.places.some((place) => place >= 0));
    different += differ;
    pixels += drawn.places.length;
  }
  assert.ok(different < 0.012 * pixels, `${different} of ${pixels} pixels differ, at edges`);
  await page.evaluate(() => (document.querySelector(".page").style.display = ""));
  await page.keyboard.press("f");
  await page.setViewportSize({ width: 800, height: 600 });
}

/** Sets the plane with the controls. */
async function cut(side, percent, flipped) {
  await page.selectOption(`${control("cut-side")}`, side);
  const field = page.locator(control("cut-at"));
  await field.fill(String(percent));
  await field.press("Enter");
  await page.selectOption(control("cut-flipped"), flipped ? "high side" : "low side");
  await page.focus(control("picture"));
}

test("a cut shows the spheres on one side of the plane, and cut spheres up to it", async () => {
  await cut("y", 50, true);
  await check({ normal: [0, -1, 0], offset: -at }, ["ArrowLeft", "ArrowUp", "+", "x", "o"]);
  await page.keyboard.press("o");
  await cut("x", 30, false);
  await check({ normal: [1, 0, 0], offset: at - 0.4 }, ["ArrowRight", "+", "y", "z"]);
  await cut("z", 75, false);
  await check({ normal: [0, 0, 1], offset: at + 0.5 }, ["ArrowUp", "+"]);
  await cut("nothing", 50, false);
  await check(undefined, ["ArrowLeft"]);
});

test("a hidden group is not drawn and cannot be picked, and can be shown again", async () => {
  await page.uncheck(control("group-0"));
  const isOdd = (place) => place >= even.length;
  await check(undefined, ["ArrowLeft"], isOdd);
  assert.equal(await page.isChecked(control("group-1")), true);
  await page.click('button[aria-label="Only even"]');
  await check(undefined, [], (place) => !isOdd(place));
  assert.equal(await page.isChecked(control("group-1")), false);
  await page.click('button[aria-label="Only even"]');
  await check(undefined, []);
});

test("another scene is shown whole", async () => {
  await page.uncheck(control("group-1"));
  await cut("x", 20, true);
  await server.ctl("load", "cradle");
  await when(page, () => spherule.session.facts.name === "cradle");
  await when(page, () => document.querySelector('[data-testid="cut-side"]').value === "nothing");
  await when(page, () => document.querySelector('[data-testid="group-1"]').checked);
  assert.equal(await page.inputValue(control("cut-flipped")), "low side");
  assert.deepEqual(page.faults, []);
});
