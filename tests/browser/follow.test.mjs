// The camera follows the selected sphere, and the picture shows its path.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { clickSphere, control, open, pause, ticks, when } from "./support/browser.mjs";
import { pictureOf } from "./support/picture.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const speed = 0.4; // m/s
const scene = {
  gravity: [0, 0, 0],
  bounds: { min: [0, 0, 0], max: [40, 2, 2] },
  camera: { eye: [3, -6, 1], target: [3, 1, 1] },
  groups: [
    { name: "flyer", list: { spheres: [{ position: [1, 1, 1], velocity: [speed, 0, 0] }] }, radius: { constant: 0.3 } },
  ],
};

let server;
let page;
const suite = browserSuite(async (browser) => {
  const file = path.join(suite.folder, "flyer.json");
  writeFileSync(file, JSON.stringify(scene));
  server = await serve(file);
  page = await open(browser, server.url, { size: [900, 600], deviceScaleFactor: 0.5, reducedMotion: "reduce" });
});

/** Where the sphere is on the canvas, and where in the scene (x, m). */
const placeOf = () =>
  page.evaluate(() => {
    const [position] = spherule.positions([0]).positions;
    return { at: spherule.project(position), x: position[0] };
  });

/** The share of the points of a line (m along x, at y = z = 1) that have the colour of a path. */
async function pathShare(from, to) {
  const points = await page.evaluate(
    ([begin, end]) => {
      const xs = Array.from({ length: 41 }, (_, k) => begin + ((end - begin) * k) / 40);
      return xs.map((x) => spherule.project([x, 1, 1]));
    },
    [from, to],
  );
  const picture = await pictureOf(page);
  const isPath = ([r, g, b]) => r > g + 40 && r > b + 60;
  return points.filter(([x, y]) => [-1, 0, 1].some((dy) => isPath(picture.at(x, y + dy)))).length / points.length;
}

test("the picture shows the path of the selected sphere from its selection on", async () => {
  await pause(page);
  await clickSphere(page, 0);
  await when(page, () => spherule.selected === 0);
  await page.keyboard.press(" ");
  const begin = (await placeOf()).x;
  await when(page, (x) => spherule.positions([0]).positions[0][0] > x, begin + 1.2);
  await pause(page);
  await ticks(page, 20);
  const { x } = await placeOf();
  assert.ok((await pathShare(begin + 0.25, x - 0.35)) > 0.9, "the path is drawn");
  assert.equal(await pathShare(x + 0.35, x + 1.2), 0, "there is no path ahead");
  await page.selectOption(control("trace"), "Hidden");
  await ticks(page, 3);
  assert.equal(await pathShare(begin + 0.25, x - 0.35), 0, "without a path");
});

test("the camera follows the sphere until the view is reset", async () => {
  await page.focus(control("picture"));
  await page.keyboard.press("g");
  await when(page, (id) => document.querySelector(id).getAttribute("aria-pressed") === "true", control("follow"));
  await page.keyboard.press(" ");
  const { x } = await placeOf();
  await when(page, (from) => spherule.positions([0]).positions[0][0] > from + 2, x);
  await pause(page);
  await ticks(page, 20);
  const followed = await placeOf();
  const target = await page.evaluate(() => spherule.camera.target[0]);
  assert.ok(Math.abs(target - followed.x) < 0.05, `the camera looks at ${target} m, the sphere is at ${followed.x} m`);
  await page.keyboard.press("f");
  await ticks(page, 3);
  assert.equal(await page.evaluate(() => spherule.camera.target[0]), 3);
  assert.equal(await page.getAttribute(control("follow"), "aria-pressed"), "false");
  assert.deepEqual(page.faults, []);
});
