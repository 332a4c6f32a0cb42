import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { control, open, pause, says, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

for (const device of ["cpu", "software"]) {
  test(`two pages show the same positions, simulated on ${device}`, async () => {
    const server = await serve("billiards", { device });
    const one = await open(suite.browser, server.url);
    const two = await open(suite.browser, server.url);
    await pause(one);
    await when(two, () => document.querySelector('[data-testid="pause"]').dataset.paused === "true");
    const state = (page) =>
      page.evaluate(() => {
        const { epoch } = spherule.session.facts;
        return JSON.stringify([epoch, spherule.positions([...Array(spherule.spheres).keys()])]);
      });
    const step = await one.evaluate(() => spherule.session.newest.step);
    await when(two, (wanted) => spherule.session.newest?.step === wanted, step);
    assert.equal(await state(two), await state(one));
    await two.selectOption(control("gravity-preset"), "Sideways");
    await when(one, () => document.querySelector('[data-testid="gravity-preset"]').value === "Sideways");
    await one.close();
    await two.close();
    await server.stop();
  });
}

test("the page reconnects to a restarted server, and shows its scene", async () => {
  const first = await serve("billiards");
  const page = await open(suite.browser, first.url);
  await first.stop();
  await when(page, () => spherule.session.connection === "waiting");
  await when(page, () => /offline/.test(document.querySelector('[data-testid="connection"]').textContent));
  const frames = await page.evaluate(() => spherule.session.frames);
  const second = await serve("bounce", { port: first.port });
  await when(
    page,
    (then) => {
      const { connection, facts, frames } = spherule.session;
      return connection === "open" && facts?.name === "bounce" && frames > then + 2;
    },
    frames,
  );
  assert.equal(await page.evaluate(() => spherule.spheres), 1);
  await page.click(control("pause"));
  await when(page, () => spherule.session.paused);
  await page.close();
  await second.stop();
});

test("a long load shows its progress and can be cancelled, and the simulation continues", async () => {
  // In such a dense scene, the search for random places without overlaps takes many seconds.
  const fill = { min: [-1, -1, -1], max: [1, 1, 1], count: 700000 };
  const bounds = { min: [-1, -1, -1], max: [1, 1, 1] };
  const scene = { name: "packed", bounds, groups: [{ radius: { constant: 0.01 }, fill }] };
  const file = path.join(suite.folder, "packed.json");
  await writeFile(file, JSON.stringify(scene));
  const server = await serve("billiards");
  const page = await open(suite.browser, server.url);
  const load = server.ctl("load", file).then(
    () => "loaded",
    (error) => error.message,
  );
  await says(page, "change", /^Loading packed: placing spheres, [1-9]\d*\u00a0%/);
  const time = await page.evaluate(() => spherule.session.newest?.simTime);
  await when(
    page,
    (then) => spherule.session.newest?.simTime > then && spherule.session.facts.name === "billiards",
    time,
  );
  if (process.env.SCREENSHOTS) await page.screenshot({ path: path.join(process.env.SCREENSHOTS, "change.png") });
  await page.click(control("change-cancel"));
  await when(page, () => document.querySelector('[data-testid="change"]').hidden);
  assert.match(await load, /refused: cancelled/);
  await page.close();
  await server.stop();
});
