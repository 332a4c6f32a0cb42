import assert from "node:assert/strict";
import { test } from "node:test";
import { chooseScene, clickSphere, control, open, pause, when } from "./support/browser.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
let page;
browserSuite(async (browser) => {
  server = await serve("cradle");
  page = await open(browser, server.url, { size: [1280, 900] });
});

/** Waits for the result of a command; returns how the newest one with this name ended. */
async function outcomeOf(command) {
  await when(page, (name) => spherule.reports.some((report) => report.name === name), command);
  return page.evaluate((name) => {
    const reports = spherule.reports.filter((report) => report.name === name);
    return reports.at(-1).outcome.case;
  }, command);
}

async function type(id, value) {
  await page.fill(control(id), String(value));
  await page.press(control(id), "Enter");
}

/** Waits until the control on the panel shows the value. */
async function shows(id, value) {
  const matches = ([selector, wanted]) => document.querySelector(selector).value === wanted;
  await when(page, matches, [control(id), String(value)]);
}

test("pause stops the simulation, and resume continues it", async () => {
  await pause(page);
  const { step } = await queryServer(page);
  await page.waitForTimeout(500);
  assert.equal((await queryServer(page)).step, step);
  await page.click(control("pause"));
  await when(page, (then) => spherule.session.newest?.step > then, step);
  assert.equal(await outcomeOf("Resume"), "applied");
});

test("stepping runs exactly the given steps, and leaves the simulation paused", async () => {
  await pause(page);
  const { step } = await queryServer(page);
  await page.fill(control("step-count"), "7");
  await page.click(control("step-many"));
  await when(page, (wanted) => spherule.session.newest?.step === wanted, step + 7);
  await page.click(control("step"));
  await when(page, (wanted) => spherule.session.newest?.step === wanted, step + 8);
  assert.equal((await queryServer(page)).step, step + 8);
});

test("gravity set on the panel reaches the simulation", async () => {
  await page.selectOption(control("gravity-preset"), "Moon");
  assert.equal(await outcomeOf("Gravity"), "applied");
  assert.deepEqual((await queryServer(page)).settings.gravity, [0, 0, -1.62]);
  await type("gravity-x", 2.5);
  await when(page, () => spherule.session.settings.gravity[0] === 2.5);
  assert.deepEqual((await queryServer(page)).settings.gravity, [2.5, 0, -1.62]);
  await page.selectOption(control("gravity-preset"), "Zero");
  await when(page, () => spherule.session.settings.gravity.every((part) => part === 0));
});

test("restitution, friction and speed set on the panel reach the simulation", async () => {
  await type("restitution", 0.35);
  await type("friction", 0.25);
  await type("speed", 0.5);
  await when(page, () => {
    const { restitution, friction, speed } = spherule.session.settings;
    return restitution === 0.35 && friction === 0.25 && speed === 0.5;
  });
  const { settings } = await queryServer(page);
  assert.deepEqual([settings.restitution, settings.friction, settings.speed], [0.35, 0.25, 0.5]);
});

test("a setting changed by another client is shown on the panel", async () => {
  await server.ctl("set", "restitution", "0.65");
  await server.ctl("set", "friction", "0.3");
  await shows("restitution", 0.65);
  await shows("friction", 0.3);
});

test("a refused command shows the reason", async () => {
  await page.fill(control("step-count"), "0");
  await page.click(control("step-many"));
  assert.equal(await outcomeOf("0 steps"), "refused");
  const toast = page.locator('[data-testid="toast"][data-tone="bad"]').last();
  const text = await toast.locator(control("toast-text")).textContent();
  assert.equal(text, "Number of steps: give a whole number from 1 to 100\u202f000.");
  assert.match(await toast.locator(control("toast-detail")).textContent(), /^step\.count is 0, must be/);
});

test("a click in push mode moves the clicked sphere away from the eye", async () => {
  await page.click(control("reset"));
  await outcomeOf("Reset");
  await pause(page);
  await page.selectOption(control("tool"), "Push");
  const before = await queryServer(page);
  const id = 4;
  await page.waitForTimeout(1500);
  const [x, y] = await page.evaluate((place) => spherule.project(place), before.positions[id]);
  assert.equal(await page.evaluate(([px, py]) => spherule.at(px, py), [x, y]), id);
  await page.mouse.click(x, y);
  assert.equal(await outcomeOf(`Push sphere ${id}`), "applied");
  await page.fill(control("step-count"), "12");
  await page.click(control("step-many"));
  await when(page, (wanted) => spherule.session.newest?.step === wanted, before.step + 12);
  const after = await queryServer(page);
  const eye = await page.evaluate(() => spherule.camera.eye);
  const away = (place) => Math.hypot(...place.map((value, axis) => value - eye[axis]));
  assert.ok(away(after.positions[id]) > away(before.positions[id]) + 0.05);
  await page.selectOption(control("tool"), "Select");
});

test("a click without push mode selects the sphere", async () => {
  await clickSphere(page, 2);
  await when(page, () => document.querySelector('[data-testid="inspected"]').textContent === "Sphere 2");
});

test("a scene from the list replaces the present one, and drops add spheres", async () => {
  await chooseScene(page, "bounce");
  await when(page, () => spherule.session.facts?.name === "bounce" && spherule.session.frames > 0);
  const before = await page.evaluate(() => spherule.spheres);
  await type("drop-count", 25);
  await page.click(control("drop"));
  assert.equal(await outcomeOf("Drop 25"), "applied");
  await when(page, (then) => spherule.spheres === then + 25, before);
  const { positions } = await queryServer(page);
  assert.equal(positions.length, before + 25);
  for (const [, , z] of positions) assert.ok(z > 0);
});

test("each colour mode has its legend", async () => {
  for (const [key, title] of Object.entries({ 1: "Speed", 2: "Radius", 3: "Id", 4: "Grid cell", 5: "Group" })) {
    await page.keyboard.press(key);
    await when(page, (wanted) => document.querySelector('[data-testid="legend-title"]').textContent === wanted, title);
  }
  await page.keyboard.press("1");
  await page.click(control("legend-lock"));
  await when(page, () => document.querySelector('[data-testid="legend-lock"]').textContent === "locked");
});

test("the help opens, and arrow keys orbit", async () => {
  await page.keyboard.press("?");
  await page.waitForSelector(`${control("help-overlay")}[open]`);
  await page.keyboard.press("Escape");
  const azimuth = await page.evaluate(() => spherule.camera.azimuth);
  await page.keyboard.press("ArrowLeft");
  await when(page, (then) => Math.abs(spherule.camera.azimuth - then) > 0.1, azimuth);
  assert.deepEqual(page.faults, []);
});

test("space and enter press the focused control", async () => {
  await pause(page);
  const { step } = await queryServer(page);
  await page.focus(control("step"));
  await page.keyboard.press("Space");
  await when(page, (wanted) => spherule.session.newest?.step === wanted, step + 1);
  await page.keyboard.press("Enter");
  await when(page, (wanted) => spherule.session.newest?.step === wanted, step + 2);
  assert.equal((await queryServer(page)).step, step + 2);
  assert.equal(await page.evaluate(() => spherule.session.paused), true);
});

test("keys of one character can be switched off, and stay off in the next page", async () => {
  const commands = () => page.evaluate(() => spherule.reports.length);
  await page.focus(control("picture"));
  await page.keyboard.press("?");
  assert.equal(await page.evaluate(() => document.activeElement.dataset.testid), "help-overlay");
  await page.uncheck(control("character-keys"));
  await page.keyboard.press("Escape");
  await page.reload();
  await when(page, () => spherule.session.frames > 0);
  const before = await commands();
  await page.focus(control("picture"));
  for (const key of ["d", ".", "?", "r"]) await page.keyboard.press(key);
  await page.waitForTimeout(500);
  assert.equal(await commands(), before);
  assert.equal(await page.isVisible(control("help-overlay")), false);
  await page.keyboard.press("Space");
  await when(page, () => spherule.reports.length > 0);
  await page.click(control("help"));
  await page.check(control("character-keys"));
  await page.keyboard.press("Escape");
  await page.keyboard.press(".");
  await when(page, () => spherule.reports.some(({ name }) => name === "One step"));
});

test("the focused canvas shows that it has the focus", async () => {
  await page.reload();
  await when(page, () => !document.querySelector("canvas").classList.contains("empty"));
  await page.keyboard.press("Tab"); // the browser shows the focus to those who use keys
  await page.focus(control("picture"));
  const style = await page.evaluate(() => {
    const { activeElement } = document;
    return [activeElement?.dataset.testid, activeElement && getComputedStyle(activeElement).outlineStyle];
  });
  assert.deepEqual(style, ["picture", "solid"]);
});
