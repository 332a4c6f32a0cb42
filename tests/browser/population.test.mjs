import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { cameraRests, control, open, pause, says, settled, when } from "./support/browser.mjs";
import { pictureOf } from "./support/picture.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const blue = [0.4, 0.8, 1.2]; // m, along x: the spheres of the scene
const red = [1.6, 2.0]; // m: the spheres that are added

/** A group of spheres at rest in a row along x. */
const row = (name, colour, xs) => ({
  name,
  colour,
  radius: { constant: 0.1 },
  list: { spheres: xs.map((x) => ({ position: [x, 0.5, 0.5] })) },
});

let server;
let page;
browserSuite(async (browser, folder) => {
  const scene = {
    gravity: [0, 0, 0],
    bounds: { min: [0, 0, 0], max: [2.4, 1, 1] },
    camera: { eye: [1.2, -3.5, 0.5], target: [1.2, 0.5, 0.5] },
    groups: [row("row", "#2040ff", blue)],
  };
  const file = path.join(folder, "row.json");
  writeFileSync(file, JSON.stringify(scene));
  server = await serve(file);
  page = await open(browser, server.url, { colour: "group", size: [760, 560], deviceScaleFactor: 0.5 });
  await pause(page); // the image settles, and changes are shown all the same
});

const epoch = () => page.evaluate(() => spherule.session.facts.epoch);
const pointOf = (x) => page.evaluate((at) => spherule.project([at, 0.5, 0.5]), x);

/** Waits until the page shows this number of spheres, in the scene and in the status line. */
async function showsSpheres(number) {
  await when(page, (wanted) => spherule.spheres === wanted, number);
  await says(page, "status-spheres", new RegExp(`^${number}$`));
}

/** The places along x (m) at which the picture shows a sphere: blue or red. */
async function drawn() {
  await settled(page);
  const picture = await pictureOf(page);
  const colours = { blue: [], red: [] };
  for (const x of [...blue, ...red]) {
    const [r, , b] = picture.at(...(await pointOf(x)));
    if (b > r + 40) colours.blue.push(x);
    if (r > b + 40) colours.red.push(x);
  }
  return colours;
}

/** Clicks on the sphere at x (m), and waits until it is selected. Returns its id. */
async function select(x) {
  await cameraRests(page);
  const [left, top] = await pointOf(x);
  await when(page, (at) => spherule.at(...at) !== undefined, [left, top]); // the image shows a sphere there
  const id = await page.evaluate((at) => spherule.at(...at), [left, top]);
  await page.mouse.click(left, top);
  await when(page, (wanted) => spherule.selected === wanted, id);
  await says(page, "inspected", new RegExp(`^Sphere ${id}$`));
  return id;
}

/** Waits for the report on the removal of a sphere from this page. */
async function reportsRemovalOf(id) {
  await when(page, (name) => spherule.reports.some((report) => report.name === name), `Remove sphere ${id}`);
  assert.match(await page.evaluate(() => spherule.reports.at(-1).text), /^removed 1 sphere$/);
  await when(page, () => spherule.selected === undefined);
}

test("spheres that are added and removed appear and disappear without a new epoch", async () => {
  await showsSpheres(3);
  assert.deepEqual(await drawn(), { blue, red: [] });
  const before = await epoch();

  await server.ctl("spawn", JSON.stringify(row("more", "#ff2010", red)));
  await showsSpheres(5);
  assert.deepEqual(await drawn(), { blue, red });

  await server.ctl(JSON.stringify({ remove: { spheres: ["1"] } }));
  await showsSpheres(4);
  assert.deepEqual(await drawn(), { blue: [blue[0], blue[2]], red });
  const [x, y] = await pointOf(blue[1]);
  assert.equal(await page.evaluate(([px, py]) => spherule.at(px, py), [x, y]), undefined);
  assert.equal(await epoch(), before);
  assert.equal((await queryServer(page)).positions.length, 4, "a client that knows no changes gets four spheres");
});

test("the button and the key remove the selected sphere", async () => {
  const before = await epoch();
  const first = await select(red[0]);
  await page.click(control("remove"));
  await reportsRemovalOf(first);
  await showsSpheres(3);

  const second = await select(red[1]);
  assert.notEqual(second, first);
  await page.keyboard.press("Delete");
  await reportsRemovalOf(second);
  await showsSpheres(2);
  assert.deepEqual(await drawn(), { blue: [blue[0], blue[2]], red: [] });
  assert.equal(await epoch(), before);
});

test("the selection ends when another client removes the sphere, and a new one has another id", async () => {
  const before = await epoch();
  const last = await select(blue[2]);
  await server.ctl(JSON.stringify({ remove: { spheres: [String(last)] } }));
  await when(page, () => spherule.selected === undefined);
  await showsSpheres(1);
  await server.ctl("spawn", JSON.stringify(row("again", "#ff2010", [blue[2]])));
  await showsSpheres(2);
  assert.ok((await select(blue[2])) > last);
  assert.equal(await epoch(), before);
  assert.deepEqual(page.faults, []);
});
