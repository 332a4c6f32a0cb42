import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { control, launch, open, when } from "./support/browser.mjs";
import { serverSays } from "./support/raw.mjs";
import { serve, stopAll } from "./support/server.mjs";

let server;
let browser;
let page;
before(async () => {
  server = await serve("box-4k");
  browser = await launch();
  page = await open(browser, server.url, { size: [1280, 900] });
  await when(page, () => spherule.dial.length > 0 && spherule.diagnostics);
});
after(async () => {
  await browser?.close();
  await stopAll();
});

const text = (id) => page.textContent(control(id));

/** Turns the dial with the keyboard, as somebody without a mouse would, and waits until that holds. */
async function turn(key) {
  const before = await page.evaluate(() => spherule.results.length);
  await page.focus(control("dial"));
  await page.keyboard.press(key);
  await when(page, (count) => spherule.results.slice(count).some(({ what }) => what === "Quality"), before);
  const index = Number(await page.inputValue(control("dial")));
  const position = await page.evaluate((i) => spherule.dial[i], index);
  await when(page, ({ model, substeps }) => spherule.settings.model === model && spherule.settings.substeps === substeps, position);
  return position;
}

test("the dial stands where the server is, and says what was measured there", async () => {
  const { settings } = await serverSays(page);
  assert.deepEqual([settings.model, settings.substeps], ["BALANCED", 8]);
  assert.equal(await text("dial-model"), "Balanced");
  assert.equal(await text("dial-substeps"), "8 substeps a step");
  assert.match(await text("dial-bed-overlap"), /^0\.\d+ %$/);
  assert.match(await text("dial-bounce-apex"), /0\.001 %$/);
  await when(page, () => /^about \S+ ms$/.test(document.querySelector('[data-testid="dial-cost"]').textContent));
  assert.match(await text("dial-pace"), /^holds real time$|^runs at \S+ × real time$/);
  const spoken = await page.getAttribute(control("dial"), "aria-valuetext");
  assert.match(spoken, /^Balanced, 8 substeps: Pile overlaps 0\.\d+ %, .*A step here about \S+ ms, So the world /);
});

test("every turn of the dial reaches the world, and its ends are the fastest and the most accurate", async () => {
  const all = await page.evaluate(() => spherule.dial);
  const fastest = await turn("Home");
  assert.deepEqual([fastest.model, fastest.substeps], [all[0].model, all[0].substeps]);
  assert.equal(fastest.model, "fast");
  const { settings } = await serverSays(page);
  assert.deepEqual([settings.model, settings.substeps], ["FAST", fastest.substeps]);
  assert.equal(await text("dial-model"), "Fast");
  const sunk = parseFloat(await text("dial-bed-overlap"));

  const next = await turn("ArrowRight");
  assert.deepEqual([next.model, next.substeps], [all[1].model, all[1].substeps]);
  const better = parseFloat(await text("dial-bed-overlap"));
  assert.ok(better < sunk, `${better} % of overlap after ${sunk} %`);

  const best = await turn("End");
  assert.equal(best.model, "accurate");
  assert.ok(best.stepMs > 4 * fastest.stepMs, "what is accurate costs more");
  assert.equal((await serverSays(page)).settings.model, "ACCURATE");
  assert.match(await text("dial-pace"), /× real time$/);
});

test("what another client sets shows on the dial, between two positions too", async () => {
  await server.ctl("set", "model", "balanced");
  await server.ctl("set", "substeps", "9");
  await when(page, () => document.querySelector('[data-testid="dial-substeps"]').textContent === "9 substeps a step");
  assert.equal(await text("dial-model"), "Balanced");
  assert.equal(await text("dial-note"), "Errors as measured with 8 substeps.");
});

test("a time per step that is too short brings the substeps down, and says so", async () => {
  await server.ctl("reset"); // what was squeezed in a fast model flies apart in an accurate one
  await server.ctl("set", "substeps", "30");
  await page.selectOption(control("auto"), "Holds a step time");
  await when(page, () => spherule.auto?.budgetMs === 16);
  await page.fill(control("goal"), "0.02");
  await page.press(control("goal"), "Enter");
  await when(page, () => spherule.auto?.budgetMs === 0.02);
  await when(page, () => spherule.settings.substeps < 30);
  await when(page, () => /substeps per step in place of|out of reach/.test(document.querySelector('[data-testid="toasts"]').textContent));
  await when(page, () => spherule.diagnostics.substeps < 30);
  assert.equal((await serverSays(page)).settings.auto.budgetMs, 0.02);
});

test("turning the dial ends auto", async () => {
  await turn("ArrowLeft");
  await when(page, () => spherule.auto === undefined);
  await when(page, () => document.querySelector('[data-testid="auto"]').value === "Off");
  assert.equal(await page.isVisible(control("goal")), false);
  assert.equal((await serverSays(page)).settings.auto, undefined);
});

test("where a model has its own substeps they are chosen anew when gravity changes, elsewhere they stay", async () => {
  const own = await page.evaluate(() => spherule.dial.findIndex((position) => position.model === "balanced" && position.own));
  await turn("Home");
  for (let i = 0; i < own; i++) await turn("ArrowRight");
  await server.ctl("set", "gravity", "0", "0", "-39.24"); // substeps go with its root
  await when(page, () => spherule.settings.substeps === 16);
  const next = await turn("ArrowRight");
  await server.ctl("set", "gravity", "0", "0", "-9.81");
  await when(page, () => spherule.settings.gravity[2] === -9.81);
  assert.equal((await serverSays(page)).settings.substeps, next.substeps);
});

test("the figures of the world come by themselves", async () => {
  const step = await page.evaluate(() => spherule.diagnostics.step);
  await when(page, (then) => spherule.diagnostics.step > then, step);
  assert.match(await text("statistics-energy"), / J$/);
  assert.match(await text("statistics-overlap-mean"), / %$/);
  assert.match(await text("statistics-step-time"), / ms$/);
  assert.match(await text("statistics-restitution"), /^not observed$|^\S+ of 0\.\d+$|^–$/);
  assert.match(await text("statistics-impacts"), /^[\d\u202f]+$|^–$/);
  assert.equal(Number(await text("statistics-substeps")), await page.evaluate(() => spherule.diagnostics.substeps));
});

test("a model that the scene has no numbers for is not on the dial, which says why", async () => {
  const half = {
    name: "half",
    bounds: { min: [0, 0, 0], max: [1, 1, 1] },
    materials: [{ name: "known", young: 1e6 }, { name: "unknown" }],
    groups: [{ name: "one", list: { spheres: [{ position: [0.5, 0.5, 0.5] }] }, radius: { constant: 0.1 } }],
  };
  await server.ctl(JSON.stringify({ load: { scene: half } }));
  await when(page, () => spherule.scene === "half" && spherule.dial.every(({ model }) => model !== "accurate"));
  assert.match(await text("dial-note"), /Accurate is not for this scene: materials\[1\]\.young/);
  const last = await turn("End");
  assert.equal(last.model, "balanced");
  assert.deepEqual(page.faults, []);
});
