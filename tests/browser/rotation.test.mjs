// A sphere that spins in place: the page shows its rotation if the user wants to see it.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { control, open, settled, when } from "./support/browser.mjs";
import { pictureOf, shareOfDifferent } from "./support/picture.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
let page;
browserSuite(async (browser, folder) => {
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

/** The canvas at rest, after `count` further steps. */
async function pictureAfter(count) {
  const before = await page.evaluate(() => spherule.session.newest.step);
  await server.ctl("step", String(count));
  await when(page, (step) => spherule.session.newest.step === step, before + count);
  await settled(page);
  return pictureOf(page);
}

const bytes = () => page.evaluate(() => spherule.session.newest.bytes);
const differs = (one, other) => shareOfDifferent(one, other, 8) > 0.005;

async function reset() {
  await server.ctl("reset");
  await when(page, () => spherule.session.newest?.step === 0);
  await settled(page);
  return pictureOf(page);
}

async function choose(name) {
  await page.selectOption(control("rotation"), { label: name });
  const sent = name === "Shown";
  await when(page, (wanted) => (spherule.session.newest?.columns.turn !== undefined) === wanted, sent);
  await settled(page);
}

test("a sphere that spins in place changes the picture only while the rotation is shown", async () => {
  const plain = await pictureAfter(20);
  const plainBytes = await bytes();
  assert.ok(!differs(plain, await pictureAfter(20)), "without the pattern, the picture is still");
  await choose("Shown");
  const first = await pictureOf(page);
  assert.ok(differs(plain, first), "the sphere has a pattern");
  const turned = await pictureAfter(20);
  assert.ok(differs(first, turned), "the pattern turns");
  const spinBytes = await bytes();
  assert.ok(spinBytes > plainBytes + 20, `${spinBytes} bytes, without spins ${plainBytes}`);
  await settled(page);
  assert.ok(!differs(turned, await pictureOf(page)), "the pattern rests while the world is paused");

  await choose("Hidden");
  assert.ok(!differs(plain, await pictureOf(page)), "the pattern has gone");
  assert.ok(!differs(plain, await pictureAfter(20)));
  assert.ok(Math.abs((await bytes()) - plainBytes) < 8, `${await bytes()} bytes, at first ${plainBytes}`);
  assert.deepEqual(page.faults, []);
});

test("orientations begin anew after a reset, and there is no choice without friction", async () => {
  await choose("Shown");
  const turned = await pictureAfter(20);
  const begun = await reset();
  assert.ok(differs(turned, begun));
  await pictureAfter(30);
  assert.ok(!differs(begun, await reset()));

  assert.ok(await page.isVisible(control("rotation")));
  await server.ctl("set", "friction", "0");
  await when(page, () => spherule.session.newest?.columns.turn === undefined);
  assert.ok(!(await page.isVisible(control("rotation"))));
  assert.deepEqual(page.faults, []);
});
