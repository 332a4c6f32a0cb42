// Sizes of the window, colours of the system, and texts of any kind: no element covers another one or the scene.
import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { control, open, pause, when } from "./support/browser.mjs";
import { collisions, coverings, showPanel } from "./support/layout.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

// A phone upright and turned, a tablet, a screen of 1280 x 720 px at a zoom of 200 %, and the same screen at 100 %.
const sizes = [[390, 844], [844, 390], [768, 1024], [640, 360], [1280, 720]];
const still = { reducedMotion: "reduce" }; // the picture needs no time to move
const scene = {
  bounds: { min: [0, 0, 0], max: [3, 2, 1.5] },
  groups: [{ name: "one", list: { spheres: [{ position: [1.5, 1, 0.5] }] }, radius: { constant: 0.4 } }],
};

let folder;
let server;
let page;
browserSuite(async (browser, own) => {
  folder = own;
  server = await serve(await sceneFile("plain", scene));
  page = await open(browser, server.url, still);
  await pause(page);
});

/** Writes a scene to a file; returns its path. */
async function sceneFile(name, content) {
  const file = path.join(folder, `${name}.json`);
  await writeFile(file, JSON.stringify(content));
  return file;
}

/** Clicks on sphere 0 when no message lies over it, and waits until the page shows its figures. */
async function select() {
  await when(page, () => document.querySelector(".toast") === null);
  const [x, y] = await page.evaluate(() => spherule.project(spherule.positions([0]).positions[0]));
  await page.mouse.click(x, y);
  await page.waitForSelector(control("inspected"));
}

for (const size of sizes) {
  test(`at ${size.join(" x ")}, nothing covers the scene, beside the panel and a selected sphere, too`, async () => {
    await page.setViewportSize({ width: size[0], height: size[1] });
    for (const open of [false, true]) {
      await showPanel(page, open);
      assert.deepEqual(await collisions(page, 5), []);
      assert.deepEqual(await coverings(page), []);
    }
    await select();
    assert.deepEqual(await collisions(page, 6), []);
    assert.deepEqual(await coverings(page), []);
    assert.equal(await page.evaluate(() => spherule.selected), 0);
    await page.focus(control("picture"));
    await page.keyboard.press("Escape");
    await when(page, () => spherule.selected === undefined);
  });
}

// Texts by scene authors, who may write anything, of at most 200 bytes.
const zalgo = "Z\u0300\u0301\u0302\u0303\u0304\u0305\u0306\u0307\u0308".repeat(10);
const hostile = {
  long: "x".repeat(200),
  wide: "\u{1242b}\ufdfd\u2e3b".repeat(14),
  rightToLeft: "\u202e\u05e9\u05dc\u05d5\u05dd \u0645\u0631\u062d\u0628\u0627 \u2067abc",
  markup: "<img src=x onerror=alert(1)><b>bold</b>&amp;",
  lines: "one\ntwo\r\nthree\u2028four\tfive",
  zalgo,
};

for (const [kind, text] of Object.entries(hostile)) {
  test(`a name and a description of the kind "${kind}" stay in their places`, async () => {
    const groups = [{ ...scene.groups[0], name: text }];
    const file = await sceneFile(kind, { ...scene, name: text, description: text, groups });
    await server.ctl("load", file);
    await when(page, (name) => document.querySelector('[data-testid="scene-name"]').title === name, text);
    await page.focus(control("picture"));
    await page.keyboard.press("5"); // colours by group
    for (const size of sizes) {
      await page.setViewportSize({ width: size[0], height: size[1] });
      await showPanel(page, true);
      assert.deepEqual(await coverings(page), [], `${size}`);
      if (size === sizes[0]) await select();
      assert.deepEqual(await collisions(page, 6), [], `${size}`);
      assert.deepEqual(await coverings(page), [], `${size}`);
    }
    const shown = await page.evaluate((selectors) => selectors.map((one) => document.querySelector(one).title), [
      control("scene-name"),
      ".swatch bdi",
    ]);
    assert.deepEqual(shown, [text, text], "the whole text is in the tooltip");
    assert.equal(await page.locator("#page img").count(), 0);
    assert.deepEqual(page.faults, []);
  });
}
