// Links to a view: copied from one page, opened in another.
import assert from "node:assert/strict";
import { test } from "node:test";
import { control, open, visit, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const size = [1280, 720];
const tokens = { viewer: "only-for-watching-0123456789", controller: "to-steer-it-0123456789abcdef" };

let server;
const suite = browserSuite(async () => {
  server = await serve("cradle");
});

const viewOf = (page) =>
  page.evaluate(() => ({
    eye: spherule.camera.eye,
    target: spherule.camera.target,
    selected: spherule.selected,
    colour: document.querySelector('[data-control="colour"] select').value,
  }));

/** Turns the camera, selects sphere 2, colours by id, and copies the link. */
async function copyLink(page) {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.mouse.move(500, 300);
  await page.mouse.down();
  await page.mouse.move(640, 350, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.press("3");
  await page.click(control("pause"));
  await when(page, () => spherule.session.paused);
  await page.waitForTimeout(1500); // the camera and the last state arrive
  const [x, y] = await page.evaluate(() => spherule.project(spherule.positions([2]).positions[0]));
  await page.mouse.click(x, y);
  await when(page, () => spherule.selected === 2);
  await page.click(control("copy-link"));
  await when(page, () => document.querySelector('[data-testid="toast"][data-tone="good"] strong') !== null);
  return page.evaluate(() => navigator.clipboard.readText());
}

const noticeIn = (page) => page.waitForSelector('[data-notice="link"]').then((notice) => notice.textContent());

test("a copied link restores camera, colours and selection, and has no other parts", async () => {
  const page = await open(suite.browser, server.url, { size });
  const link = await copyLink(page);
  const address = new URL(link);
  assert.equal(`${address.origin}/`, server.url);
  assert.equal(address.search, "");
  assert.deepEqual([...new URLSearchParams(address.hash.slice(1)).keys()], ["scene", "camera", "colour", "sphere"]);
  const other = await open(suite.browser, link, { size });
  await when(other, () => spherule.selected === 2);
  const [copied, restored] = [await viewOf(page), await viewOf(other)];
  assert.deepEqual([restored.selected, restored.colour], [copied.selected, copied.colour]);
  for (const part of ["eye", "target"]) {
    restored[part].forEach((value, axis) => assert.ok(Math.abs(value - copied[part][axis]) < 1e-4, part));
  }
  assert.deepEqual([...page.faults, ...other.faults], []);
  await page.close();
  await other.close();
});

test("a link to another scene asks before it loads it, and then shows its view", async () => {
  const link = `${server.url}#scene=bounce&colour=radius&camera=3,-4,2,0,0,1`;
  const page = await open(suite.browser, link, { size });
  assert.match(await noticeIn(page), /This link is for bounce.*The server shows cradle/);
  assert.notEqual((await viewOf(page)).colour, "Radius");
  assert.match(await server.ctl("query"), /./);
  assert.equal(await page.evaluate(() => spherule.session.facts.name), "cradle");
  await page.click(control("notice-load"));
  await when(page, () => spherule.session.facts.name === "bounce");
  const isThere = (wanted) =>
    [...spherule.camera.eye, ...spherule.camera.target].every((value, k) => Math.abs(value - wanted[k]) < 1e-6);
  await when(page, isThere, [3, -4, 2, 0, 0, 1]);
  assert.equal((await viewOf(page)).colour, "Radius");
  await when(page, () => document.querySelector('[data-notice="link"]') === null);
  await page.evaluate(() => (location.hash = "#scene=cradle")); // as if the user pasted another link
  await noticeIn(page);
  await page.click(control("notice-dismiss"));
  await when(page, () => document.querySelector('[data-notice="link"]') === null);
  assert.equal(await page.evaluate(() => spherule.session.facts.name), "bounce");
  await page.close();
});

test("a viewer cannot load the link's scene, and an unknown scene cannot be loaded at all", async () => {
  const guarded = await serve("cradle", { tokens });
  const page = await visit(suite.browser, `${guarded.url}#scene=bounce`, { size });
  await page.fill(control("token-field"), tokens.viewer);
  await page.click(control("token-connect"));
  await noticeIn(page);
  assert.equal(await page.isDisabled(control("notice-load")), true);
  assert.match(await page.getAttribute(control("notice-load"), "title"), /watch/);
  await page.evaluate(() => (location.hash = "#scene=of%20my%20own"));
  await when(page, () => /does not have of my own/.test(document.querySelector('[data-notice="link"]').textContent));
  assert.equal(await page.locator(control("notice-load")).count(), 0);
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click(control("copy-link"));
  await when(page, () => document.querySelector('[data-testid="toast"][data-tone="good"]') !== null);
  const copied = await page.evaluate(() => navigator.clipboard.readText());
  for (const token of Object.values(tokens)) assert.equal(copied.includes(token), false);
  await page.close();
  await guarded.stop();
});

test("bad parts of a link are named and ignored", async () => {
  const page = await open(suite.browser, `${server.url}#colour=pink&camera=1,2&sphere=99999&what=1`, { size });
  const texts = () => page.locator(control("toast-text")).allTextContents();
  await when(page, () => document.querySelectorAll('[data-testid="toast"][data-tone="bad"]').length === 2);
  const [first, second] = await texts();
  assert.match(first, /“pink”.*camera.*“what”/s);
  assert.match(second, /There is no sphere 99\u202f999/);
  const { selected } = await viewOf(page);
  assert.equal(selected, undefined);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("where the browser forbids copying, the link is in the address bar", async () => {
  const page = await open(suite.browser, server.url, { size });
  await page.evaluate(() => (navigator.clipboard.writeText = () => Promise.reject(new Error("forbidden"))));
  await page.click(control("copy-link"));
  await when(page, () => location.hash.includes("camera="));
  assert.match(await page.locator(control("toast-text")).last().textContent(), /address bar/);
  await page.close();
});
