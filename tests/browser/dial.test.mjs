import assert from "node:assert/strict";
import { test } from "node:test";
import { control, open, says, unfold, when } from "./support/browser.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
let page;
browserSuite(async (browser) => {
  server = await serve("box-4k", { options: ["--contact-sums"] });
  page = await open(browser, server.url, { size: [1280, 900] });
  await when(page, () => spherule.session.dial?.positions.length > 0 && spherule.session.diagnostics);
});

const text = (id) => page.textContent(control(id));

/** The positions of the dial; `model` is a number of the enum. */
const positions = () =>
  page.evaluate(() =>
    spherule.session.dial.positions.map(({ model, substeps, stepMs, own }) => ({ model, substeps, stepMs, own })),
  );

/** Turns the dial with a key, and waits until the settings match its position. */
async function turn(key) {
  const before = await page.evaluate(() => spherule.reports.length);
  await page.focus(control("dial"));
  await page.keyboard.press(key);
  await when(page, (count) => spherule.reports.slice(count).some(({ name }) => name === "Quality"), before);
  const index = Number(await page.inputValue(control("dial")));
  const position = (await positions())[index];
  await when(
    page,
    ({ model, substeps }) =>
      spherule.session.settings.model === model && spherule.session.settings.substeps === substeps,
    position,
  );
  return position;
}

test("the dial shows the present settings, with the measured errors", async () => {
  const { settings } = await queryServer(page);
  assert.deepEqual([settings.model, settings.substeps], ["BALANCED", 8]);
  assert.equal(await text("dial-model"), "Balanced");
  assert.equal(await text("dial-substeps"), "8 substeps a step");
  assert.match(await text("dial-bed-overlap"), /^0\.\d+ %$/);
  assert.match(await text("dial-bounce-apex"), /0\.001 %$/);
  await says(page, "dial-cost", /^about \S+ ms$/);
  assert.match(await text("dial-pace"), /^holds real time$|^runs at \S+ × real time$/);
  const spoken = await page.getAttribute(control("dial"), "aria-valuetext");
  assert.match(spoken, /^Balanced, 8 substeps: Overlap in piles 0\.\d+ %, .*Step time about \S+ ms, Speed /);
});

test("each turn of the dial changes the settings, from the fastest to the most accurate", async () => {
  const all = await positions();
  const fastest = await turn("Home");
  assert.deepEqual([fastest.model, fastest.substeps], [all[0].model, all[0].substeps]);
  const { settings } = await queryServer(page);
  assert.deepEqual([settings.model, settings.substeps], ["FAST", fastest.substeps]);
  assert.equal(await text("dial-model"), "Fast");
  const sunk = parseFloat(await text("dial-bed-overlap"));

  const next = await turn("ArrowRight");
  assert.deepEqual([next.model, next.substeps], [all[1].model, all[1].substeps]);
  const better = parseFloat(await text("dial-bed-overlap"));
  assert.ok(better < sunk, `${better} % of overlap after ${sunk} %`);

  const best = await turn("End");
  assert.deepEqual([best.model, best.substeps], [all.at(-1).model, all.at(-1).substeps]);
  assert.ok(best.stepMs > 4 * fastest.stepMs, "accuracy costs time");
  assert.equal((await queryServer(page)).settings.model, "ACCURATE");
  assert.equal(await text("dial-model"), "Accurate");
  assert.match(await text("dial-pace"), /× real time$/);
});

test("settings of another client are shown on the dial, also between two positions", async () => {
  await server.ctl("set", "model", "balanced");
  await server.ctl("set", "substeps", "9");
  await says(page, "dial-substeps", /^9 substeps a step$/);
  assert.equal(await text("dial-model"), "Balanced");
  assert.equal(await text("dial-note"), "Errors are those measured with 8 substeps.");
});

/** Waits until the server holds this step time (ms). */
async function goalIs(budgetMs) {
  await when(
    page,
    (wanted) => {
      const goal = spherule.session.settings.auto?.goal;
      return goal?.case === "budgetMs" && goal.value === wanted;
    },
    budgetMs,
  );
}

test("a step time that is too short reduces the substeps, with a message", async () => {
  await server.ctl("reset"); // overlaps of the fast model make spheres fly apart in the accurate one
  await server.ctl("set", "substeps", "30");
  await page.selectOption(control("auto"), "Hold step time");
  await goalIs(16);
  await page.fill(control("goal"), "0.02");
  await page.press(control("goal"), "Enter");
  await goalIs(0.02);
  await when(page, () => spherule.session.settings.substeps < 30);
  await says(page, "toasts", /substeps per step in place of|out of reach/);
  await when(page, () => spherule.session.diagnostics.substeps < 30);
  assert.equal((await queryServer(page)).settings.auto.budgetMs, 0.02);
});

test("turning the dial ends the automatic mode", async () => {
  await turn("ArrowLeft");
  await when(page, () => !spherule.session.settings.auto?.goal.case);
  await when(page, () => document.querySelector('[data-testid="auto"]').value === "Off");
  assert.equal(await page.isVisible(control("goal")), false);
  assert.equal((await queryServer(page)).settings.auto, undefined);
});

test("a model's own substeps follow gravity, and others are kept", async () => {
  const [fast, ...others] = await positions();
  const own = 1 + others.findIndex((position) => position.model !== fast.model && position.own);
  await turn("Home");
  for (let i = 0; i < own; i++) await turn("ArrowRight");
  await server.ctl("set", "gravity", "0", "0", "-39.24"); // substeps are proportional to its square root
  await when(page, () => spherule.session.settings.substeps === 16);
  const next = await turn("ArrowRight");
  await server.ctl("set", "gravity", "0", "0", "-9.81");
  await when(page, () => spherule.session.settings.gravity[2] === -9.81);
  assert.equal((await queryServer(page)).settings.substeps, next.substeps);
});

test("diagnostics are updated regularly", async () => {
  await unfold(page, "Now");
  const step = await page.evaluate(() => Number(spherule.session.diagnostics.statistics.step));
  await when(page, (then) => spherule.session.diagnostics.statistics.step > then, step);
  assert.match(await text("statistics-energy"), / [nµmkMGT]?J$/);
  assert.match(await text("statistics-overlap-mean"), / %$/);
  assert.match(await text("statistics-step-time"), / ms$/);
  assert.match(await text("statistics-restitution"), /^not measured$|^\S+ of 0\.\d+$|^–$/);
  assert.match(await text("statistics-impacts"), /^[\d\u202f]+$|^–$/);
  const shownSubsteps = Number(await text("statistics-substeps"));
  assert.equal(shownSubsteps, await page.evaluate(() => spherule.session.diagnostics.substeps));
});

test("forces on the walls are among the diagnostics, in a scene with contact sums", async () => {
  await unfold(page, "Statistics");
  assert.match(await text("statistics-collisions"), /^[\d\u202f]+$/);
  assert.match(await text("statistics-dissipated"), / [nµmkMGT]?J$/);
  assert.match(await text("statistics-force-Z_MIN"), /^\S+ {2}\S+ {2}−\S+$/);
  assert.notEqual(await text("statistics-torque-X_MAX"), "");
});

test("a long name of a surface beside three long numbers fits into the panel", async () => {
  const sticksOut = await page.evaluate(() => {
    const value = document.querySelector('[data-testid="statistics-torque-X_MAX"]');
    const name = value.parentElement.querySelector("span");
    const [nameBefore, valueBefore] = [name.textContent, value.textContent];
    name.textContent = "Torque on obstacles[1023], N m";
    value.textContent = "−0.000123  −0.000123  −0.000123";
    const panel = document.querySelector('[data-testid="panel"]').getBoundingClientRect();
    const right = value.getBoundingClientRect().right - panel.right;
    [name.textContent, value.textContent] = [nameBefore, valueBefore];
    return right;
  });
  assert.ok(sticksOut < 0, `${sticksOut} px`);
});

test("a model that the scene does not support is missing on the dial, with a reason", async () => {
  const half = {
    name: "half",
    bounds: { min: [0, 0, 0], max: [1, 1, 1] },
    materials: [{ name: "known", young: 1e6 }, { name: "unknown" }],
    groups: [{ name: "one", list: { spheres: [{ position: [0.5, 0.5, 0.5] }] }, radius: { constant: 0.1 } }],
  };
  await server.ctl(JSON.stringify({ load: { scene: half } }));
  await when(page, () => spherule.session.facts.name === "half");
  await says(page, "dial-note", /Accurate is not available: materials\[1\]\.young/);
  await turn("End");
  assert.equal(await text("dial-model"), "Balanced");
  assert.deepEqual(page.faults, []);
});
