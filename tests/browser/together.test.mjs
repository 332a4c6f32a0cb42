import assert from "node:assert/strict";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { control, launch, open, pause, when } from "./support/browser.mjs";
import { serve, stopAll } from "./support/server.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await stopAll();
});

for (const device of ["cpu", "software"]) {
  test(`two pages see the same world, computed by ${device}`, async () => {
    const server = await serve("billiards", { device });
    const one = await open(browser, server.url);
    const two = await open(browser, server.url);
    await pause(one);
    await when(two, () => document.querySelector('[data-testid="pause"]').dataset.paused === "true");
    const state = (page) => page.evaluate(() => JSON.stringify([spherule.epoch, spherule.positions([...Array(spherule.count).keys()])]));
    await when(two, (step) => spherule.step === step, await one.evaluate(() => spherule.step));
    assert.equal(await state(two), await state(one));
    await two.selectOption(control("gravity-preset"), "Sideways");
    await when(one, () => document.querySelector('[data-testid="gravity-preset"]').value === "Sideways");
    await one.close();
    await two.close();
    await server.stop();
  });
}

test("the page finds a restarted server by itself and shows its world", async () => {
  const first = await serve("billiards");
  const page = await open(browser, first.url);
  await first.stop();
  await when(page, () => spherule.connection === "waiting");
  await when(page, () => /offline/.test(document.querySelector('[data-testid="connection"]').textContent));
  const frames = await page.evaluate(() => spherule.frames);
  const second = await serve("bounce", { port: first.port });
  await when(page, (then) => spherule.connection === "open" && spherule.scene === "bounce" && spherule.frames > then + 2, frames);
  assert.equal(await page.evaluate(() => spherule.count), 1);
  await page.click(control("pause"));
  await when(page, () => spherule.paused);
  await page.close();
  await second.stop();
});

test("a command given without a connection is said to be lost", async () => {
  const server = await serve("bounce");
  const page = await open(browser, server.url);
  await server.stop();
  await when(page, () => spherule.connection !== "open");
  await page.click(control("reset"));
  await when(page, () => spherule.results.at(-1)?.outcome === "lost");
  await page.close();
});

test("a long load shows how far it has come, and the world goes on until it is cancelled", async () => {
  const folder = await mkdtemp(path.join(os.tmpdir(), "spherule-"));
  // Random places without overlaps are hard to find so close together: looking for them takes many seconds.
  const fill = { min: [-1, -1, -1], max: [1, 1, 1], count: 700000 };
  const scene = { name: "packed", bounds: { min: [-1, -1, -1], max: [1, 1, 1] }, groups: [{ radius: { constant: 0.01 }, fill }] };
  const file = path.join(folder, "packed.json");
  await writeFile(file, JSON.stringify(scene));
  const server = await serve("billiards");
  const page = await open(browser, server.url);
  const load = server.ctl("load", file).then(
    () => "loaded",
    (error) => error.message,
  );
  await when(page, () => /^load packed: placing spheres, [1-9]\d* %$/.test(document.querySelector('[data-testid="change"] p').textContent));
  const time = await page.evaluate(() => spherule.simTime);
  await when(page, (then) => spherule.simTime > then && spherule.scene === "billiards", time);
  if (process.env.SCREENSHOTS) await page.screenshot({ path: path.join(process.env.SCREENSHOTS, "change.png") });
  await page.click(control("change-cancel"));
  await when(page, () => document.querySelector('[data-testid="change"]').hidden);
  assert.match(await load, /refused: cancelled/);
  await page.close();
  await server.stop();
  await rm(folder, { recursive: true });
});
