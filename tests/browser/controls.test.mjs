import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { control, launch, open, pause, when } from "./support/browser.mjs";
import { serverSays } from "./support/raw.mjs";
import { serve, stopAll } from "./support/server.mjs";

let server;
let browser;
let page;
before(async () => {
  server = await serve("cradle");
  browser = await launch();
  page = await open(browser, server.url, { size: [1280, 900] });
});
after(async () => {
  await browser?.close();
  await stopAll();
});

/** Waits for the answer to the newest command and returns it. */
async function answer(what) {
  await when(page, (name) => spherule.results.some((result) => result.what === name), what);
  return page.evaluate((name) => spherule.results.filter((result) => result.what === name).at(-1), what);
}

async function type(id, value) {
  await page.fill(control(id), String(value));
  await page.press(control(id), "Enter");
}

/** Waits until the control on the panel shows the value. */
async function shows(id, value) {
  await when(page, ([name, wanted]) => document.querySelector(`[data-testid="${name}"]`).value === wanted, [id, String(value)]);
}

test("pause stops the world and resume lets it go on", async () => {
  await pause(page);
  const { step } = await serverSays(page);
  await page.waitForTimeout(500);
  assert.equal((await serverSays(page)).step, step);
  await page.click(control("pause"));
  await when(page, (then) => spherule.step > then, step);
  assert.equal((await answer("Resume")).outcome, "applied");
});

test("step n goes exactly n steps and leaves the world paused", async () => {
  await pause(page);
  const { step } = await serverSays(page);
  await page.fill(control("step-count"), "7");
  await page.click(control("step-many"));
  await when(page, (wanted) => spherule.step === wanted, step + 7);
  await page.click(control("step"));
  await when(page, (wanted) => spherule.step === wanted, step + 8);
  assert.equal((await serverSays(page)).step, step + 8);
});

test("gravity from the panel is the world's gravity", async () => {
  await page.selectOption(control("gravity-preset"), "Moon");
  assert.equal((await answer("Gravity")).outcome, "applied");
  assert.deepEqual((await serverSays(page)).settings.gravity, [0, 0, -1.62]);
  await type("gravity-x", 2.5);
  await when(page, () => spherule.settings.gravity[0] === 2.5);
  assert.deepEqual((await serverSays(page)).settings.gravity, [2.5, 0, -1.62]);
  await page.selectOption(control("gravity-preset"), "Zero");
  await when(page, () => spherule.settings.gravity.every((part) => part === 0));
});

test("restitution, friction and speed from the panel reach the world", async () => {
  await type("restitution", 0.35);
  await type("friction", 0.25);
  await type("speed", 0.5);
  await when(page, () => spherule.settings.restitution === 0.35 && spherule.settings.friction === 0.25 && spherule.settings.speed === 0.5);
  const { settings } = await serverSays(page);
  assert.deepEqual([settings.restitution, settings.friction, settings.speed], [0.35, 0.25, 0.5]);
});

test("a setting that another client changed shows on the panel", async () => {
  await server.ctl("set", "restitution", "0.65");
  await server.ctl("set", "friction", "0.3");
  await shows("restitution", 0.65);
  await shows("friction", 0.3);
});

test("a refused command says why", async () => {
  await page.fill(control("step-count"), "0");
  await page.click(control("step-many"));
  const refused = await answer("0 steps");
  assert.equal(refused.outcome, "refused");
  const toast = page.locator('[data-testid="toast"][data-tone="bad"]').last();
  assert.match(await toast.textContent(), /refused: .+/);
});

test("a click in push mode moves the sphere that was clicked, away from the eye", async () => {
  await page.click(control("reset"));
  await answer("Reset");
  await pause(page);
  await page.check(control("push"));
  const before = await serverSays(page);
  const id = 4;
  await page.waitForTimeout(1500);
  const [x, y] = await page.evaluate((place) => spherule.project(place), before.positions[id]);
  assert.equal(await page.evaluate(([px, py]) => spherule.at(px, py), [x, y]), id);
  await page.mouse.click(x, y);
  assert.equal((await answer(`Push sphere ${id}`)).outcome, "applied");
  await page.fill(control("step-count"), "12");
  await page.click(control("step-many"));
  await when(page, (wanted) => spherule.step === wanted, before.step + 12);
  const after = await serverSays(page);
  const eye = await page.evaluate(() => spherule.camera.eye);
  const away = (place) => Math.hypot(...place.map((value, axis) => value - eye[axis]));
  assert.ok(away(after.positions[id]) > away(before.positions[id]) + 0.05);
  await page.uncheck(control("push"));
});

test("a click otherwise tells about the sphere", async () => {
  const { positions } = await serverSays(page);
  const [x, y] = await page.evaluate((place) => spherule.project(place), positions[2]);
  await page.mouse.click(x, y);
  await when(page, () => document.querySelector('[data-testid="inspected"]').textContent === "Sphere 2");
});

test("a scene from the list replaces the world, and drops add to it", async () => {
  await page.selectOption(control("scene"), "bounce");
  await when(page, () => spherule.scene === "bounce" && spherule.frames > 0);
  const before = await page.evaluate(() => ({ count: spherule.count, epoch: spherule.epoch }));
  await type("drop-count", 25);
  await page.click(control("drop"));
  assert.equal((await answer("Drop 25")).outcome, "applied");
  await when(page, (then) => spherule.count === then.count + 25 && spherule.epoch > then.epoch, before);
  const said = await serverSays(page);
  assert.equal(said.positions.length, before.count + 25);
  for (const [, , z] of said.positions) assert.ok(z > 0);
});

test("each way of colouring has its legend", async () => {
  for (const [key, title] of Object.entries({ 1: "Speed", 2: "Radius", 3: "Id", 4: "Grid cell", 5: "Group" })) {
    await page.keyboard.press(key);
    await when(page, (wanted) => document.querySelector('[data-testid="legend-title"]').textContent === wanted, title);
  }
  await page.keyboard.press("1");
  await page.click(control("legend-lock"));
  await when(page, () => document.querySelector('[data-testid="legend-lock"]').textContent === "locked");
});

test("the keys that help lists are the keys that work", async () => {
  await page.keyboard.press("?");
  await page.waitForSelector(`${control("help-overlay")}[open]`);
  await page.keyboard.press("Escape");
  const azimuth = await page.evaluate(() => spherule.camera.azimuth);
  await page.keyboard.press("ArrowLeft");
  await when(page, (then) => Math.abs(spherule.camera.azimuth - then) > 0.1, azimuth);
  assert.deepEqual(page.faults, []);
});
