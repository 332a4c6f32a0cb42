import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { chooseScene, control, open, pause, visit, when } from "./support/browser.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

/** Runs in the page before its own code. Notes the scenes that it asks for, and passes on no request while held. */
function watchLoads() {
  window.loads = { asked: [], held: false };
  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (message, ...rest) {
    const kind = message?.command?.kind;
    if (kind?.case === "load") window.loads.asked.push(kind.value.source.value);
    if (kind?.case !== "load" || !window.loads.held) post.call(this, message, ...rest);
  };
}

let server;
let page;
const suite = browserSuite(async (browser) => {
  server = await serve("cradle");
  page = await open(browser, server.url, { size: [1280, 720], init: watchLoads });
});

const pictures = () => page.requested.filter((url) => url.includes("/scenes/"));

test("pictures are fetched when the gallery opens, and each scene has one", async () => {
  assert.deepEqual(pictures(), []);
  await page.click(control("scenes"));
  await page.waitForSelector(`${control("gallery")}[open]`);
  const known = await page.evaluate(() => spherule.session.welcome.gallery.map(({ name }) => name));
  assert.ok(known.length > 10);
  await when(page, () => [...document.querySelectorAll(".gallery img")].every((image) => image.complete));
  const shown = await page.evaluate(() =>
    [...document.querySelectorAll(".gallery img")].filter((image) => image.naturalWidth > 0).map((image) => image.src),
  );
  assert.deepEqual(
    shown.map((url) => new URL(url).pathname),
    known.map((name) => `/scenes/${name}.webp`),
  );
  assert.deepEqual(page.faults, []);
});

test("a card has the number of spheres and the description, and the present scene is marked", async () => {
  const text = await page.textContent(control("scene-billiards"));
  assert.match(text, /billiards\s*16 spheres/);
  assert.match(text, /A cue ball breaks a rack/);
  const advice = await page.textContent(control("what-to-try"));
  assert.ok(advice.length > 20, "the present scene has something to try");
  assert.ok((await page.textContent(control("scene-cradle"))).includes(advice));
  assert.match(await page.textContent(control("scene-box-10k")), /10\u202f000 spheres/);
  const marked = await page.evaluate(() =>
    [...document.querySelectorAll(".gallery [aria-current]")].map((card) => card.dataset.testid),
  );
  assert.deepEqual(marked, ["scene-cradle"]);
});

test("keys choose a scene, and steer nothing behind the gallery", async () => {
  assert.equal(await page.evaluate(() => document.activeElement.dataset.testid), "scene-cradle");
  const azimuth = await page.evaluate(() => spherule.camera.azimuth);
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("r");
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => spherule.camera.azimuth), azimuth);
  await page.keyboard.press("Tab");
  const next = await page.evaluate(() => document.activeElement.dataset.testid.replace("scene-", ""));
  await page.keyboard.press("Enter");
  await when(page, (name) => spherule.session.facts.name === name && spherule.session.frames > 0, next);
  assert.equal(await page.isVisible(control("gallery")), false);
  await when(page, () => spherule.reports.length > 0); // the answer may come after the first frame
  assert.deepEqual(await page.evaluate(() => spherule.reports.map(({ name }) => name)), [`Scene ${next}`]);
  // A scene with many obstacles takes the processor from the tests below.
  await server.ctl("load", "cradle");
  await when(page, () => spherule.session.facts.name === "cradle");
  await page.click(control("scenes"));
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible(control("gallery")), false);
});

test("one click on any card asks for its scene", async () => {
  await pause(page); // a page that draws is slow to click on
  const known = await page.evaluate(() => spherule.session.welcome.gallery.map(({ name }) => name));
  await page.evaluate(() => (window.loads = { asked: [], held: true }));
  for (const name of known) {
    await chooseScene(page, name);
    assert.equal(await page.isVisible(control("gallery")), false, name);
  }
  assert.deepEqual(await page.evaluate(() => window.loads.asked), known);
  await page.evaluate(() => (window.loads.held = false));
  for (const name of ["two-spheres", "bounce", "billiards", "cradle"]) {
    await chooseScene(page, name);
    await when(page, (wanted) => spherule.session.facts.name === wanted, name);
    assert.equal((await queryServer(page)).facts.name, name);
  }
  assert.deepEqual(page.faults, []);
});

test("without control the cards are disabled, with the reason", async () => {
  const tokens = { viewer: "only-for-watching-0123456789", controller: "to-steer-it-0123456789abcdef" };
  const guarded = await serve("bounce", { tokens });
  const watcher = await visit(suite.browser, guarded.url, { size: [1280, 720] });
  await watcher.fill(control("token-field"), tokens.viewer);
  await watcher.click(control("token-connect"));
  await when(watcher, () => spherule.session.frames > 0);
  await watcher.click(control("scenes"));
  assert.notEqual(await watcher.textContent(control("gallery-note")), "");
  const card = watcher.locator(control("scene-billiards"));
  assert.equal(await card.getAttribute("aria-disabled"), "true");
  assert.equal(`${await card.getAttribute("title")}.`, await watcher.textContent(control("gallery-note")));
  await card.press("Enter");
  await card.click({ force: true }); // else it waits until the card is enabled
  assert.equal(await watcher.isVisible(control("gallery")), true);
  assert.equal(await watcher.evaluate(() => spherule.reports.length), 0);
  await watcher.close();
  await guarded.stop();
});

test("a scene of the user's own has a card without a picture", async () => {
  const own = { name: "my own", bounds: { min: [0, 0, 0], max: [1, 1, 1] }, groups: [] };
  own.groups.push({ list: { spheres: [{ position: [0.5, 0.5, 0.5] }] }, radius: { constant: 0.1 } });
  const file = path.join(suite.folder, "own.json");
  await writeFile(file, JSON.stringify(own));
  await server.ctl("load", file);
  await when(page, () => spherule.session.facts.name === "my own");
  await page.click(control("scenes"));
  const card = page.locator(control("scene-my own"));
  assert.equal(await card.getAttribute("aria-current"), "true");
  assert.match(await card.textContent(), /1 sphere$/);
  assert.equal(await card.locator("img").count(), 0);
  assert.deepEqual(page.faults, []);
});
