// Sizes of the window, colours of the system, and texts of any kind: no element covers another one or the scene.
import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { clickSphere, control, open, pause, when } from "./support/browser.mjs";
import { collisions, coverings, galleryFaults, showPanel, sizes } from "./support/layout.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const still = { reducedMotion: "reduce" }; // the picture needs no time to move
const scene = {
  bounds: { min: [0, 0, 0], max: [3, 2, 1.5] },
  groups: [{ name: "one", list: { spheres: [{ position: [1.5, 1, 0.5] }] }, radius: { constant: 0.4 } }],
};

let server;
let page; // paused
let offline; // a page whose server has ended, with a selected sphere
const suite = browserSuite(async (browser) => {
  const file = await sceneFile("plain", scene);
  [server, page] = await paused(browser, file);
  const [ended, other] = await paused(browser, file);
  await coverings(other); // waits until the picture stands still
  await select(other);
  await ended.stop();
  await other.waitForSelector(control("notice"));
  offline = other;
});

/** Serves the scene of a file. Returns the server and a page that shows it paused. */
async function paused(browser, file) {
  const own = await serve(file);
  const shown = await open(browser, own.url, still);
  await pause(shown);
  return [own, shown];
}

/** Writes a scene to a file; returns its path. */
async function sceneFile(name, content) {
  const file = path.join(suite.folder, `${name}.json`);
  await writeFile(file, JSON.stringify(content));
  return file;
}

/** Clicks on sphere 0 when no message lies over it, and waits until the page shows its figures. */
async function select(one) {
  await when(one, () => document.querySelector(".toast") === null);
  await clickSphere(one, 0);
  await one.waitForSelector(control("inspected"));
}

for (const size of sizes) {
  test(`at ${size.join(" x ")}, nothing covers the scene, beside the panel and a selected sphere, too`, async () => {
    await page.setViewportSize({ width: size[0], height: size[1] });
    for (const open of [false, true]) {
      await showPanel(page, open);
      assert.deepEqual(await collisions(page, 5), []);
      assert.deepEqual(await coverings(page), []);
    }
    await select(page);
    assert.deepEqual(await collisions(page, 6), []);
    assert.deepEqual(await coverings(page), []);
    assert.equal(await page.evaluate(() => spherule.selected), 0);
    await page.focus(control("picture"));
    await page.keyboard.press("Escape");
    await when(page, () => spherule.selected === undefined);
  });
}

for (const size of sizes) {
  test(`at ${size.join(" x ")}, a notice and a long state of the connection cover nothing`, async () => {
    await offline.setViewportSize({ width: size[0], height: size[1] });
    for (const open of [false, true]) {
      await showPanel(offline, open);
      assert.deepEqual(await collisions(offline, 7), [], open ? "with the panel" : "without the panel");
      if (!open) assert.deepEqual(await coverings(offline), []);
    }
  });
}

test("the gallery fits into each window, and none of its parts covers another", async () => {
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    assert.deepEqual(await galleryFaults(page), [], `${width} x ${height}`);
  }
});

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
      if (size === sizes[0]) {
        assert.deepEqual(await galleryFaults(page), [], `the gallery at ${size}`);
        await select(page);
      }
      assert.deepEqual(await collisions(page, 6), [], `${size}`);
      assert.deepEqual(await coverings(page), [], `${size}`);
    }
    const shown = await page.evaluate(
      (selectors) => selectors.map((one) => document.querySelector(one).title),
      [control("scene-name"), ".swatch bdi"],
    );
    assert.deepEqual(shown, [text, text], "the whole text is in the tooltip");
    assert.equal(await page.locator(".page img:not([src^='scenes/'])").count(), 0);
    assert.deepEqual(page.faults, []);
  });
}
