// A sphere that spins in place: the page shows its rotation if the user wants to see it.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { control, open, settled, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
let page;
const suite = browserSuite(async (browser, folder) => {
  const scene = {
    name: "top",
    gravity: [0, 0, 0],
    step: 0.01,
    bounds: { min: [-1, -1, -1], max: [1, 1, 1] },
    materials: [{ name: "rubber", friction: 0.5 }],
    camera: { eye: [0, -3, 0.5], target: [0, 0, 0] },
    groups: [{ name: "top", list: { spheres: [{ position: [0, 0, 0] }] }, radius: { constant: 0.4 }, spin: [0, 1, 2] }],
  };
  const file = path.join(folder, "top.json");
  writeFileSync(file, JSON.stringify(scene));
  server = await serve("two-spheres");
  await server.ctl("pause");
  await server.ctl("load", file); // stays paused
  page = await open(browser, server.url);
});

/** The image of the sphere. */
async function sphere() {
  const [x, y] = await page.evaluate(() => spherule.project([0, 0, 0]));
  return page.screenshot({ clip: { x: x - 60, y: y - 60, width: 120, height: 120 } });
}

/** Waits until the image of the sphere is another one. */
async function changes(before) {
  for (let tries = 0; before.equals(await sphere()); tries++) {
    assert.ok(tries < 60, "the image stays the same");
    await page.waitForTimeout(200);
  }
}

/** The image of the sphere at rest. */
async function restingSphere() {
  await settled(page);
  return sphere();
}

/** Runs steps; returns the size (bytes) of the frame after them. */
async function run(count) {
  const before = await page.evaluate(() => spherule.session.newest.step);
  await server.ctl("step", String(count));
  await when(page, (step) => spherule.session.newest?.step === step, before + count);
  return page.evaluate(() => spherule.session.newest.bytes);
}

/** The size of the smallest of some frames: now and then, a frame is a keyframe or has a hash. */
async function smallestFrame() {
  const sizes = [];
  for (let k = 0; k < 5; k++) sizes.push(await run(4));
  return Math.min(...sizes);
}

/** The orientation of the sphere in the newest state. */
const orientation = () => page.evaluate(() => [...spherule.session.newest.columns.turn.values]);

async function reset() {
  await server.ctl("reset");
  await when(page, () => spherule.session.newest?.step === 0);
}

async function choose(name) {
  await page.selectOption(control("rotation"), { label: name });
  const sent = name === "Shown";
  await when(page, (wanted) => (spherule.session.newest?.columns.turn !== undefined) === wanted, sent);
}

test("a sphere that spins in place changes the picture while its rotation is shown", async () => {
  const plain = await restingSphere();
  await choose("Shown");
  await changes(plain);
  const begun = await restingSphere();
  await run(20);
  await changes(begun);
  assert.ok((await restingSphere()).equals(await restingSphere()), "a paused world is still");
});

test("frames without the rotation have no more bytes, and their picture is still", async () => {
  const shownBytes = await smallestFrame();
  await choose("Hidden");
  const plain = await restingSphere();
  const bytes = await smallestFrame();
  assert.ok(bytes < shownBytes - 20, `${bytes} bytes, with spins ${shownBytes}`);
  assert.ok(plain.equals(await restingSphere()));
});

test("orientations begin anew after a reset", async () => {
  await choose("Shown");
  await reset();
  const begun = await orientation();
  await run(20);
  assert.notDeepEqual(await orientation(), begun);
  await reset();
  assert.deepEqual(await orientation(), begun);
});

test("a recording, which has no rotation, offers no choice", async () => {
  assert.ok(await page.isVisible(control("rotation")));
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(control("save"))]);
  const file = path.join(suite.folder, "top.sph");
  await download.saveAs(file);
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.click(control("open-file"))]);
  await chooser.setFiles(file);
  await when(page, () => spherule.session.replay?.source === "file" && spherule.session.newest);
  await page.waitForSelector(control("rotation"), { state: "hidden" });
  await page.click(control("present"));
  await when(page, () => !spherule.session.replay && spherule.session.newest);
  await page.waitForSelector(control("rotation"));
});

test("a scene without friction offers no choice, and its frames have no rotation", async () => {
  assert.ok(await page.isVisible(control("rotation")));
  await server.ctl("set", "friction", "0");
  await when(page, () => spherule.session.newest?.columns.turn === undefined);
  await page.waitForSelector(control("rotation"), { state: "hidden" });
  assert.deepEqual(page.faults, []);
});
