import assert from "node:assert/strict";
import { test } from "node:test";
import { control, open, when } from "./support/browser.mjs";
import { collisions, collisionsByWidth } from "./support/layout.mjs";
import { proxyTo } from "./support/proxy.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
const suite = browserSuite(async () => {
  server = await serve("billiards");
});

test("the page loads, connects, and shows scene and device", async () => {
  const page = await open(suite.browser, server.url);
  assert.equal(await page.textContent(control("scene-name")), "billiards");
  assert.equal(await page.textContent(control("connection")), "connected");
  await when(page, () => document.querySelector('[data-testid="status-spheres"]').textContent === "16");
  assert.match(await page.textContent(control("status-renderer")), /^cpu · .*threads?, \d+ lanes$/);
  assert.match(await page.getAttribute(".field.renderer", "title"), /asked for as cpu/);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("nothing is fetched from anywhere else", async () => {
  const page = await open(suite.browser, server.url);
  const elsewhere = page.requested.filter((url) => new URL(url).origin !== new URL(server.url).origin);
  assert.deepEqual(elsewhere, []);
  await page.close();
});

test("the first load takes at most 120 kB, and the next transfers no file", async () => {
  const proxy = await proxyTo(server.port);
  const context = await suite.browser.newContext(); // with a cache of its own
  const load = async () => {
    await (await open(context, proxy.url)).close();
    const { answers, bytes } = proxy.files();
    return { answers: answers.filter((answer) => !answer.startsWith("/favicon.svg ")).sort(), bytes };
  };
  const files = ["/", "/style.css", "/viewer.js", "/worker.js"];
  const first = await load();
  assert.deepEqual(
    first.answers,
    files.map((path) => `${path} 200`),
  );
  assert.ok(first.bytes <= 120_000, `${first.bytes} bytes`);
  const both = await load();
  assert.deepEqual(
    both.answers,
    files.flatMap((path) => [`${path} 200`, `${path} 304`]),
  );
  assert.ok(both.bytes - first.bytes < 5_000, `${both.bytes - first.bytes} bytes`);
  await context.close();
  proxy.close();
});

test("states arrive, and simulated time advances", async () => {
  const page = await open(suite.browser, server.url);
  const before = await page.evaluate(() => ({
    frames: spherule.session.frames,
    time: spherule.session.newest.simTime,
  }));
  await when(
    page,
    ({ frames, time }) => spherule.session.frames > frames + 3 && spherule.session.newest.simTime > time,
    before,
  );
  await page.close();
});

for (const [width, height] of [
  [1280, 720],
  [1920, 1080],
  [390, 844],
]) {
  test(`no element covers another one at ${width} x ${height}`, async () => {
    const page = await open(suite.browser, server.url, { size: [width, height] });
    if (width < 700) assert.equal(await page.isVisible(control("panel")), false);
    assert.deepEqual(await collisions(page, 5), []);
    await page.close();
  });
}

test("no element covers another one at other widths, with the panel shown or hidden", async () => {
  const page = await open(suite.browser, server.url, { size: [1280, 720] });
  for (const { width, faults } of await collisionsByWidth(page, 5)) assert.deepEqual(faults, [], `${width} px`);
  await page.close();
});

test("a lost graphics context is restored, and images are drawn again", async () => {
  const page = await open(suite.browser, server.url);
  await page.evaluate(() => {
    window.loss = document.querySelector("canvas").getContext("webgl2").getExtension("WEBGL_lose_context");
    window.loss.loseContext();
  });
  const lost = (selector) => document.querySelector(selector).dataset.state === "lost";
  const found = (selector) => document.querySelector(selector).dataset.state === "open";
  await when(page, lost, control("retry"));
  await page.evaluate(() => window.loss.restoreContext());
  await when(page, found, control("retry"));
  const drawn = await page.evaluate(() => spherule.drawn);
  await when(page, (then) => spherule.drawn > then + 1, drawn);
  assert.deepEqual(page.faults, []);
  await page.close();
});
