import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { control, launch, open, when } from "./support/browser.mjs";
import { collisions, collisionsByWidth } from "./support/layout.mjs";
import { serve, stopAll } from "./support/server.mjs";

let server;
let browser;
before(async () => {
  server = await serve("billiards");
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await stopAll();
});

test("the page loads, connects and says what it shows", async () => {
  const page = await open(browser, server.url);
  assert.equal(await page.textContent(control("scene-name")), "billiards");
  assert.equal(await page.textContent(control("connection")), "connected");
  await when(page, () => document.querySelector('[data-testid="status-spheres"]').textContent === "16");
  assert.match(await page.textContent(control("status-renderer")), /^cpu · .*threads?$/);
  assert.match(await page.getAttribute(".field.renderer", "title"), /asked for as cpu/);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("nothing is fetched from anywhere else", async () => {
  const page = await open(browser, server.url);
  const elsewhere = page.requested.filter((url) => new URL(url).origin !== new URL(server.url).origin);
  assert.deepEqual(elsewhere, []);
  await page.close();
});

test("states keep coming and time goes on", async () => {
  const page = await open(browser, server.url);
  const before = await page.evaluate(() => ({ frames: spherule.frames, time: spherule.simTime }));
  await when(page, (then) => spherule.frames > then.frames + 3 && spherule.simTime > then.time, before);
  await page.close();
});

for (const [width, height] of [
  [1280, 720],
  [1920, 1080],
  [390, 844],
]) {
  test(`nothing on the page covers anything else at ${width} x ${height}`, async () => {
    const page = await open(browser, server.url, { size: [width, height] });
    if (width < 700) assert.equal(await page.isVisible(control("panel")), false);
    assert.deepEqual(await collisions(page, 5), []);
    await page.close();
  });
}

test("nor does it at any width between, with the controls shown or hidden", async () => {
  const page = await open(browser, server.url, { size: [1280, 720] });
  for (const { width, faults } of await collisionsByWidth(page, 5)) assert.deepEqual(faults, [], `${width} px`);
  await page.close();
});

test("a lost graphics context comes back with its picture", async () => {
  const page = await open(browser, server.url);
  await page.evaluate(() => {
    window.loss = document.querySelector("canvas").getContext("webgl2").getExtension("WEBGL_lose_context");
    window.loss.loseContext();
  });
  await when(page, () => spherule.picture.contextLost);
  await page.evaluate(() => window.loss.restoreContext());
  await when(page, () => !spherule.picture.contextLost);
  const drawn = await page.evaluate(() => spherule.picture.drawn);
  await when(page, (then) => spherule.picture.drawn > then + 1, drawn);
  assert.deepEqual(page.faults, []);
  await page.close();
});
