// The tools that act on a place of the picture, with the real server: pull, drop, and the arrow of gravity.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { beforeEach, test } from "node:test";
import { control, open, patience, says, when } from "./support/browser.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const places = [
  [-0.5, 0, 1],
  [0.5, 0, 1],
]; // m
const mass = 1000 * (4 / 3) * Math.PI * 0.15 ** 3; // kg

let server;
let page;
const suite = browserSuite(async (browser, folder) => {
  const file = path.join(folder, "two.json");
  const spheres = places.map((position) => ({ position }));
  const scene = {
    name: "two",
    gravity: [0, 0, 0],
    bounds: { min: [-1.5, -1.5, 0], max: [1.5, 1.5, 2] },
    camera: { eye: [0, -7, 1.3], target: [0, 0, 1] },
    groups: [{ name: "two", radius: { constant: 0.15 }, list: { spheres } }],
  };
  writeFileSync(file, JSON.stringify(scene));
  server = await serve(file);
  page = await open(browser, server.url, { size: [1280, 800] });
  await page.mouse.move(10, 10); // the page loads the tools
  await page.waitForSelector(control("gravity-arrow"));
  await page.waitForTimeout(1500); // the camera moves
});

beforeEach(async () => {
  const before = await page.evaluate(() => spherule.session.states.epoch);
  await server.ctl("reset");
  await when(page, (epoch) => spherule.session.states.epoch !== epoch && spherule.session.newest, before);
  await page.selectOption(control("tool"), "Select");
  await page.keyboard.press("Escape");
});

/** The point of the canvas that shows a place (m); waits until a sphere is drawn there, if `id` is given. */
async function pointOf(place, id) {
  if (id !== undefined) {
    const shows = ([at, wanted]) => spherule.at(...spherule.project(at)) === wanted;
    await when(page, shows, [place, id]);
  }
  return page.evaluate((at) => spherule.project(at), place);
}

/** Waits until a sphere of the server is at a place (m). */
async function arrives(id, place, within = 0.03) {
  const end = Date.now() + patience;
  for (;;) {
    const { positions } = await queryServer(page);
    const distance = Math.hypot(...positions[id].map((part, axis) => part - place[axis]));
    if (distance < within) return;
    assert.ok(Date.now() < end, `sphere ${id} is at ${positions[id]}, not at ${place}`);
    await page.waitForTimeout(100);
  }
}

const releases = () => page.evaluate(() => spherule.reports.filter(({ name }) => name === "Release").length);

test("dragging a sphere pulls it to the pointer, with the force as text, until the button is up", async () => {
  await page.selectOption(control("tool"), "Pull");
  const from = await pointOf(places[0], 0);
  const goal = [-0.5, 0, 1.6];
  const to = await pointOf(goal);
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(from[0], (from[1] + to[1]) / 2, { steps: 4 });
  await page.mouse.move(...to, { steps: 4 });
  await says(page, "pull-force", /^[\d.,]+ N$/);
  const eye = await page.evaluate(() => spherule.camera.eye);
  assert.ok(eye[1] < -5, "the drag does not turn the view");
  await arrives(0, goal);
  const { positions } = await queryServer(page);
  assert.ok(Math.abs(positions[1][2] - 1) < 0.01, "the other sphere stays");
  await page.mouse.up();
  await when(page, () => spherule.reports.some(({ name }) => name === "Release"));
  await page.waitForSelector(control("pull-force"), { state: "hidden" });
  // Nothing pulls it back.
  await server.ctl("push", "0", "0", "0", String(-0.3 * mass));
  await page.waitForTimeout(800);
  assert.ok((await queryServer(page)).positions[0][2] < 1.55);
});

test("a touch pulls, too", async () => {
  const other = await open(suite.browser, server.url, { size: [1280, 800], hasTouch: true });
  await other.mouse.move(10, 10); // the page loads the tools
  await other.waitForSelector(control("gravity-arrow"));
  await other.selectOption(control("tool"), "Pull");
  const shows = ([at, wanted]) => spherule.at(...spherule.project(at)) === wanted;
  await when(other, shows, [places[1], 1]);
  const [x, y] = await other.evaluate((at) => spherule.project(at), places[1]);
  const [toX, toY] = await other.evaluate((at) => spherule.project(at), [0.9, 0, 1]);
  const session = await other.context().newCDPSession(other);
  const touch = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await touch("touchStart", [{ x, y }]);
  for (let k = 1; k <= 5; k++) {
    await touch("touchMove", [{ x: x + ((toX - x) * k) / 5, y: y + ((toY - y) * k) / 5 }]);
  }
  await arrives(1, [0.9, 0, 1]);
  await touch("touchEnd", []);
  await when(other, () => spherule.reports.some(({ name }) => name === "Release"));
  assert.deepEqual(other.faults, []);
  await other.close();
});

test("keys pull the selected sphere, and Escape releases it", async () => {
  await page.selectOption(control("tool"), "Pull");
  await page.mouse.click(...(await pointOf(places[1], 1)));
  await when(page, () => spherule.selected === 1);
  await page.focus(control("picture"));
  for (let k = 0; k < 3; k++) await page.keyboard.press("ArrowUp");
  await says(page, "pull-force", /N$/);
  const end = Date.now() + patience;
  while ((await queryServer(page)).positions[1][2] < 1.2) assert.ok(Date.now() < end, "the sphere does not rise");
  const before = await releases();
  await page.keyboard.press("Escape");
  await when(page, (count) => spherule.reports.filter(({ name }) => name === "Release").length > count, before);
  assert.equal(await page.evaluate(() => spherule.selected), 1, "still selected");
});

test("the pull of a page that is closed ends", async () => {
  const other = await open(suite.browser, server.url, { size: [1280, 800] });
  await other.mouse.move(10, 10); // the page loads the tools
  await other.waitForSelector(control("gravity-arrow"));
  await other.selectOption(control("tool"), "Pull");
  const shows = ([at, wanted]) => spherule.at(...spherule.project(at)) === wanted;
  await when(other, shows, [places[0], 0]);
  const [x, y] = await other.evaluate((at) => spherule.project(at), places[0]);
  await other.mouse.move(x, y);
  await other.mouse.down();
  await other.mouse.move(x, y - 60, { steps: 5 });
  const end = Date.now() + patience;
  while ((await queryServer(page)).positions[0][2] < 1.1) assert.ok(Date.now() < end, "the sphere is not pulled");
  await other.close();
  // Without a spring, a push moves it away for good.
  await page.waitForTimeout(500);
  await server.ctl("push", "0", String(-0.5 * mass), "0", "0");
  await page.waitForTimeout(1500);
  assert.ok((await queryServer(page)).positions[0][0] < -0.9);
});

test("a click of the tool Drop drops spheres above the place", async () => {
  await page.selectOption(control("tool"), "Drop");
  for (const [id, value] of [
    ["drop-count", "5"],
    ["drop-radius", "0.04"],
  ]) {
    await page.fill(control(id), value);
    await page.press(control(id), "Enter");
  }
  await page.mouse.click(...(await pointOf(places[1], 1)));
  await when(page, () => spherule.spheres === 7);
  for (const [x, y, z] of (await queryServer(page)).positions.slice(2)) {
    assert.ok(Math.hypot(x - 0.5, y) < 0.3 && z > 1.15, `${[x, y, z]} is not above the sphere`);
  }
  // The keyboard drops at the middle of the picture.
  await page.focus(control("picture"));
  await page.keyboard.press("Enter");
  await when(page, () => spherule.spheres === 12);
});

test("the tool Drop says how to go on when there is no room", async () => {
  await page.selectOption(control("tool"), "Drop");
  for (const [id, value] of [
    ["drop-count", "5000"],
    ["drop-radius", "0.3"],
  ]) {
    await page.fill(control(id), value);
    await page.press(control(id), "Enter");
  }
  await page.mouse.click(...(await pointOf(places[0], 0)));
  const text = page.locator('[data-testid="toast"][data-tone="bad"]').last();
  assert.match(await text.textContent(), /Drop fewer|make them smaller|Give a radius/);
  assert.equal(await page.evaluate(() => spherule.spheres), 2);
});

test("gravity is dragged as an arrow, and changed by keys and buttons", async () => {
  const gravity = async () => (await queryServer(page)).settings.gravity ?? [0, 0, 0];
  await server.ctl("set", "gravity", "0", "0", "-5");
  await when(page, () => document.querySelector('[data-testid="gravity-arrow"]').ariaValueNow === "5");
  const box = await page.locator(control("gravity-arrow")).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y + 30);
  await page.mouse.down();
  await page.mouse.move(x + 45, y, { steps: 10 });
  await page.mouse.up();
  await when(page, () => spherule.session.settings.gravity[0] > 4.9);
  const turned = await gravity();
  assert.ok(Math.abs(Math.hypot(...turned) - 5) < 1e-3 && turned[0] > 4.9, `${turned} points to the right`);
  await page.focus(control("gravity-arrow"));
  await page.keyboard.press("ArrowUp");
  await when(page, () => Math.abs(Math.hypot(...spherule.session.settings.gravity) - 5.5) < 1e-3);
  await page.click(control("gravity-down"));
  await when(page, () => Math.abs(spherule.session.settings.gravity[2] + 5.5) < 1e-3);
  await page.click(control("gravity-zero"));
  await when(page, () => spherule.session.settings.gravity.every((part) => part === 0));
  assert.deepEqual(page.faults, []);
});
