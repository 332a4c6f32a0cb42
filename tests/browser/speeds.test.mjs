import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { clickSphere, control, open, says, unfold, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const speeds = [0, 0.245, 3, 0.02]; // m/s, by id
const radius = 0.05; // m
const x = (id) => 0.3 * (id - 1.5); // m

let server;
let page;
const suite = browserSuite(async (_, folder) => {
  const scene = {
    gravity: [0, 0, 0],
    step: 0.001,
    bounds: { min: [-40, -1, -40], max: [40, 1, 40] },
    materials: [{ name: "glass", density: 1000 }],
    camera: { eye: [0, -4, 0], target: [0, 0, 0] },
    groups: [
      {
        name: "movers",
        list: { spheres: speeds.map((speed, id) => ({ position: [x(id), 0, 0], velocity: [0, 0, speed] })) },
        radius: { constant: radius },
      },
    ],
  };
  const file = path.join(folder, "movers.json");
  writeFileSync(file, JSON.stringify(scene));
  server = await serve("two-spheres");
  await server.ctl("pause");
  await server.ctl("load", file); // stays paused
  page = await open(suite.browser, server.url, { size: [1000, 700] });
  await unfold(page, "Stream");
});

/** Waits until the page shows the speed of a sphere, within 1 %. */
async function expectSpeed(id, speed) {
  await clickSphere(page, id);
  await says(page, "inspected", new RegExp(`^Sphere ${id}$`));
  const shown = ([selector, wanted]) => {
    const text = document.querySelector(selector).parentElement.parentElement.textContent;
    const found = /(^|[^–\d.])([\d.]+(e−\d+)?) m\/s/.exec(text)?.[2].replace("−", "-");
    return found !== undefined && Math.abs(Number(found) - wanted) <= 0.01 * wanted;
  };
  await when(page, shown, [control("inspected"), speed]);
}

test("a page that has seen only one state of a paused world shows speeds", async () => {
  for (const [id, speed] of speeds.entries()) await expectSpeed(id, speed);
});

for (const tier of ["Eco", "Normal", "Fine"]) {
  test(`speeds are true in the tier ${tier}, while time passes and in a pause`, async () => {
    const label = await page.evaluate(
      ([selector, name]) =>
        [...document.querySelector(selector).options].find(({ label: one }) => one.startsWith(name)).label,
      [control("tier"), tier],
    );
    await page.selectOption(control("tier"), { label });
    await says(page, "stream-tier", new RegExp(`^${tier}`));
    await expectSpeed(1, speeds[1]);
    await server.ctl("step", "20");
    await expectSpeed(3, speeds[3]);
    await expectSpeed(1, speeds[1]);
  });
}

test("a push changes the speed that a paused world shows", async () => {
  const mass = 1000 * (4 / 3) * Math.PI * radius ** 3;
  await server.ctl("push", "0", String(2 * mass), "0", "0");
  await expectSpeed(0, 2);
  await expectSpeed(1, speeds[1]);
  assert.deepEqual(page.faults, []);
});

test("the legend of speeds spans the speeds, and the stream has none while none are shown", async () => {
  await page.selectOption(control("colour"), { label: "Speed" });
  await says(page, "legend", /3 m\/s/);
  await page.keyboard.press("Escape"); // deselects
  await page.selectOption(control("colour"), { label: "Id" });
  await when(page, () => spherule.session.newest?.columns.value === undefined);
  await page.selectOption(control("colour"), { label: "Speed" });
  await when(page, () => spherule.session.newest?.columns.value !== undefined);
  assert.deepEqual(page.faults, []);
});
