// Reading the scene: colours by contacts, overlap and energy, the selected sphere, the ends of a scale, charts.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { beforeEach, test } from "node:test";
import { clickSphere, control, open, says, unfold, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const radius = 0.05; // m
const mass = 2500 * (4 / 3) * Math.PI * radius ** 3; // kg

// A row of spheres. Each of the first four overlaps the next one by 10 % of the radius; the last one moves alone.
const places = [0, 0.095, 0.19, 0.285, 0.6].map((x) => [x - 0.3, 0, 0]);

let server;
let page;
browserSuite(async (browser, folder) => {
  const spheres = places.map((position, id) => ({ position, velocity: [0, 0, id === 4 ? 2 : 0] }));
  const scene = {
    name: "row",
    gravity: [0, 0, 0],
    step: 0.001,
    bounds: { min: [-40, -1, -40], max: [40, 1, 40] },
    materials: [{ name: "glass", density: 2500 }],
    quality: { model: "FAST" },
    camera: { eye: [0, -3, 0], target: [0, 0, 0] },
    contactSums: true,
    groups: [{ name: "beads", list: { spheres }, radius: { constant: radius } }],
  };
  const file = path.join(folder, "row.json");
  writeFileSync(file, JSON.stringify(scene));
  server = await serve("two-spheres");
  await server.ctl("pause");
  await server.ctl("load", file); // stays paused
  page = await open(browser, server.url, { size: [1280, 800] });
});

beforeEach(async () => {
  await page.keyboard.press("Escape");
});

/** Waits until the states that are shown have this quantity, and returns its values. */
async function valuesOf(quantity) {
  await when(page, (wanted) => spherule.session.newest?.columns.value?.quantity === wanted, quantity);
  return page.evaluate(() => [...spherule.session.newest.columns.value.values.slice(0, 5)]);
}

test("each colour mode has the values of its quantity, and its legend spans them", async () => {
  await page.selectOption(control("colour"), { label: "Contacts" });
  assert.deepEqual((await valuesOf(2)).map(Math.round), [1, 2, 2, 1, 0]);
  await says(page, "legend", /5 bodies/);
  await page.selectOption(control("colour"), { label: "Overlap" });
  const overlaps = await valuesOf(3);
  for (const overlap of overlaps.slice(0, 4)) assert.ok(Math.abs(overlap / 0.1 - 1) < 0.02, `${overlap}`);
  assert.equal(overlaps[4], 0);
  await says(page, "legend", /20 % of the radius/);
  await page.selectOption(control("colour"), { label: "Energy" });
  const energies = await valuesOf(4);
  assert.ok(Math.abs(energies[4] / (2 * mass) - 1) < 0.01, `${energies[4]}`);
  await says(page, "legend", /Energy.*0 J.+J/);
  assert.deepEqual(page.faults, []);
});

test("the selected sphere is described, and a click on a contact selects that sphere", async () => {
  await page.selectOption(control("colour"), { label: "Id" });
  await clickSphere(page, 1);
  await says(page, "inspected", /^Sphere 1$/);
  await says(page, "contacts", /^touches 2: 02$/);
  const text = await page.textContent(".inspector");
  for (const part of ["0 m/s", "velocity", "spin", "mass 1.31 kg", "radius 5 cm, beads", "material glass", "10 %"]) {
    assert.ok(text.includes(part), `${part} in ${text}`);
  }
  await page.click(`${control("contacts")} button[title="Select sphere 2"]`);
  await says(page, "inspected", /^Sphere 2$/);
  await says(page, "contacts", /^touches 2: 13$/);
  await clickSphere(page, 4);
  await says(page, "contacts", /^no contacts$/);
  await page.waitForFunction(() => document.querySelector(".inspector").textContent.includes("2 m/s"));
});

test("a push of a paused world changes what is told of the sphere", async () => {
  await clickSphere(page, 3);
  await says(page, "contacts", /^touches 1: 2$/);
  await server.ctl("push", "3", String(3 * mass), "0", "0");
  const told = () => document.querySelector(".inspector").textContent.includes("velocity 3.00  0.00  0.00 m/s");
  await when(page, told);
});

test("the ends of a scale are typed, and an empty field returns to the automatic end", async () => {
  await page.selectOption(control("colour"), { label: "Speed" });
  await page.click(control("legend-high"));
  await page.fill(control("range-high"), "8");
  await page.keyboard.press("Enter");
  await says(page, "legend-high", /^8 m\/s$/);
  await page.fill(control("range-low"), "9");
  await page.keyboard.press("Enter");
  await says(page, "range-wrong", /Give a number of at most 8.m\/s/);
  assert.equal(await page.getAttribute(control("range-low"), "aria-invalid"), "true");
  await page.fill(control("range-low"), "0.5");
  await page.keyboard.press("Enter");
  await says(page, "legend-low", /^0.5$/);
  for (const end of ["low", "high"]) {
    await page.fill(control(`range-${end}`), "");
    await page.keyboard.press("Enter");
  }
  await says(page, "legend-low", /^0$/);
  await says(page, "legend-high", /^3 m\/s$/); // of the sphere that was pushed
  await page.click(control("legend-high"));
  assert.equal(await page.isVisible(control("range-high")), false);
});

test("charts are loaded when their folder is opened, and begin again with a new run", async () => {
  const loaded = () => page.requested.filter((address) => address.includes("charts."));
  assert.deepEqual(loaded(), []);
  await unfold(page, "Charts");
  await page.waitForSelector(`${control("chart-image")} canvas`);
  assert.equal(loaded().length, 1); // its style is in the same file
  await server.ctl("resume");
  await when(page, () => spherule.session.samples.list.length > 2);
  await says(page, "chart-values", /kinetic[\d.]+ J.*total[\d.]+ J/);
  await page.selectOption(control("chart"), { label: "Forces on walls" });
  await says(page, "chart-values", /Z_MIN0 N/);
  const name = await page.getAttribute(control("chart-image"), "aria-label");
  assert.match(name, /^Forces on walls, from [\d.]+ s to [\d.]+ s$/);
  await page.selectOption(control("chart"), { label: "Energies" });
  await server.ctl("pause");
  await server.ctl("reset");
  await when(page, () => spherule.session.samples.list.length === 1);
  await says(page, "chart-values", /at 0.00 s/);
  assert.deepEqual(page.faults, []);
});
