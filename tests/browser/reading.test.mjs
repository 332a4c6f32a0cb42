// Reading the scene: colours by a quantity, the selected sphere, the ends of a scale, charts.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { beforeEach, test } from "node:test";
import { cameraRests, clickSphere, control, open, says, settled, unfold, when } from "./support/browser.mjs";
import { pictureOf } from "./support/picture.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const radius = 0.05; // m
const mass = 2500 * (4 / 3) * Math.PI * radius ** 3; // kg

// A row of spheres. Each of the first four overlaps the next one by 10 % of the radius; the last one moves alone.
const places = [0, 0.095, 0.19, 0.285, 0.6].map((x) => [x - 0.3, 0, 0]);

let server;
let page;
const suite = browserSuite(async (browser, folder) => {
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
  page = await open(browser, server.url, { size: [1280, 800], deviceScaleFactor: 0.5 });
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
  await server.ctl("query"); // a reading of the same state by another client
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

/** A low sphere and two high ones that stand still, of groups with these colours and of different materials. */
function shelf(low, high) {
  const group = (name, places, colour, material) => ({
    name,
    list: { spheres: places.map((position) => ({ position })) },
    radius: { constant: 0.1 },
    fixed: true,
    colour,
    material,
  });
  return {
    name: `shelf ${low}`,
    bounds: { min: [-1, -1, 5], max: [1, 1, 8] },
    camera: { eye: [0, -7, 6.3], target: [0, 0, 6.3] },
    materials: [{ name: "felt" }, { name: "rubber" }, { name: "steel" }],
    groups: [
      group("low", [[0, 0, 5.1]], low, "steel"),
      group(
        "high",
        [
          [0, 0, 6.9],
          [0.5, 0, 6.9],
        ],
        high,
        "rubber",
      ),
    ],
  };
}

/** Loads the scene, chooses the colour mode, and returns the colours of the low sphere and a high one. */
async function coloursOf(scene, mode, arrange = () => {}) {
  const file = path.join(suite.folder, "shelf.json");
  writeFileSync(file, JSON.stringify(scene));
  await server.ctl("load", file);
  await when(page, (name) => spherule.session.facts.name === name && spherule.session.newest, scene.name);
  await page.selectOption(control("colour"), { label: mode });
  await arrange();
  await cameraRests(page);
  await settled(page);
  const { at } = await pictureOf(page);
  const middles = await page.evaluate(() => spherule.positions([0, 1]).positions.map(spherule.project));
  return middles.map(([x, y]) => at(x, y));
}

function expectSame(colours, expected) {
  const differences = colours.flat().map((part, k) => Math.abs(part - expected.flat()[k]));
  assert.ok(Math.max(...differences) <= 3, `${JSON.stringify(colours)} instead of ${JSON.stringify(expected)}`);
}

test("colours by height reach from one end of the scale to the other", async () => {
  const ends = ["#2f4858", "#f1e3a6"]; // of the ramp
  const expected = await coloursOf(shelf(...ends), "Group");
  const colours = await coloursOf(shelf("#ff0000", "#0000ff"), "Height", async () => {
    await says(page, "legend-low", /^0 m$/);
    await says(page, "legend-high", /^2 m$/); // above 1.9 m, the height of the high spheres
    await page.click(control("legend-low"));
    for (const [end, height] of [
      ["low", "0.1"],
      ["high", "1.9"],
    ]) {
      await page.fill(control(`range-${end}`), height);
      await page.keyboard.press("Enter");
    }
    await says(page, "legend-low", /^10 cm$/);
    await says(page, "legend-high", /^1.9 m$/);
  });
  expectSame(colours, expected);
});

test("colours by material have a legend with the names and the numbers of spheres", async () => {
  const [second, third] = ["#b16d42", "#37a286"]; // of the palette
  const expected = await coloursOf(shelf(third, second), "Group");
  const colours = await coloursOf(shelf("#ff0000", "#0000ff"), "Material");
  const entries = await page.locator(".legend .swatch").allTextContents();
  assert.deepEqual(entries, ["rubber2", "steel1"]);
  expectSame(colours, expected);
  assert.deepEqual(page.faults, []);
});
