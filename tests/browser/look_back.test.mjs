// The last seconds of a simulation: shown again, and saved as a recording.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import path from "node:path";
import { beforeEach, test } from "node:test";
import { chooseScene, control, evaluateLarge, open, says, visit, when } from "./support/browser.mjs";
import { gasScene, logStates } from "./support/gas.mjs";
import { collisions, showPanel, sizes } from "./support/layout.mjs";
import { queryServer } from "./support/raw.mjs";
import { play, serve, spherule } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const slider = control("timeline");

let gas;
let server;
let page;
const suite = browserSuite(async (browser, folder) => {
  gas = await gasScene(folder);
  server = await serve(gas);
  page = await open(browser, server.url, { size: [1280, 720], colour: "id" });
});

/** Waits until the page has a past of this duration (s). */
async function hasPast(seconds, of = page) {
  await when(of, (least) => spherule.session.past?.end - spherule.session.past?.begin >= least, seconds);
}

/** Presses the timeline at a share of its length. */
async function pressAt(share, of = page) {
  const { x, y, width, height } = await of.locator(slider).boundingBox();
  await of.mouse.click(x + 8 + share * (width - 16), y + height / 2);
}

const showsPast = (of = page) => when(of, () => spherule.session.replay?.source === "past" && !spherule.seeking);
// When the button is disabled, the page has drawn the timeline of the present.
const showsPresent = (of = page) =>
  when(
    of,
    (button) => spherule.session.replay === undefined && document.querySelector(button)?.disabled,
    control("present"),
  );

beforeEach(async () => {
  if (await page.evaluate(() => spherule.session.replay !== undefined)) await page.click(control("present"));
  await showsPresent();
});

test("the handle is at the right end, and the page says that it is live", async () => {
  await hasPast(1);
  assert.equal(await page.textContent(control("timeline-position")), "live");
  assert.equal(await page.isDisabled(control("present")), true);
  const left = await page.locator(slider).evaluate((element) => element.max - element.valueAsNumber);
  assert.ok(Math.abs(left) < 1e-6);
});

test("the past is shown as it was, at the speed of the world, while the world goes on", async () => {
  await logStates(page);
  await hasPast(5);
  await when(page, () => window.seen.size > 30);
  await pressAt(0.6);
  await showsPast();
  await says(page, "connection", /the past/);
  await says(page, "timeline-position", /^−\d+\.\d s$/);
  const compared = await page.evaluate(async () => {
    const { session } = spherule;
    const handle = session.handle;
    const compared = { states: 0, worst: 0 };
    session.handle = (message) => {
      handle(message);
      const before = message.kind === "frame" && window.seen.get(message.frame.simTime);
      if (!before || !session.replay) return;
      compared.states += 1;
      const { positions } = spherule.positions([...before.keys()]);
      const errors = positions.flatMap((place, id) => place.map((value, axis) => Math.abs(value - before[id][axis])));
      compared.worst = Math.max(compared.worst, ...errors);
    };
    for (let k = 0; k < 600 && compared.states < 30 && session.replay; k++) {
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    session.handle = handle;
    return compared;
  });
  assert.ok(compared.states >= 30, `${compared.states} states were seen twice`);
  assert.equal(compared.worst, 0);
  const { step } = await queryServer(page);
  const { shown, ago, speed } = await page.evaluate(async () => {
    const moment = () => ({ at: spherule.session.newest.at, end: spherule.session.past.end });
    const first = moment();
    await new Promise((resolve) => setTimeout(resolve, 2000));
    const last = moment();
    const speed = (last.at - first.at) / (last.end - first.end);
    return { shown: spherule.session.newest.step, ago: last.end - last.at, speed };
  });
  const later = await queryServer(page);
  assert.ok(later.step > step, "the world goes on");
  assert.ok(shown < later.step, "what is shown came before");
  assert.ok(ago > 0.5, `${ago} s ago`);
  assert.ok(speed > 0.5 && speed < 2, `played at ${speed} times the speed`);
});

test("pause, step and keys act on the past, and the world goes on", async () => {
  await hasPast(6);
  await pressAt(0.5);
  await showsPast();
  await page.keyboard.press("Escape");
  await page.focus(control("picture"));
  await page.keyboard.press(" ");
  await when(page, () => spherule.session.paused);
  const before = await page.evaluate(() => spherule.session.newest.step);
  await page.click(control("step"));
  await when(page, (step) => spherule.session.newest.step > step, before);
  await when(
    page,
    (selector) => Math.abs(document.querySelector(selector).valueAsNumber - spherule.session.newest.at) < 1e-6,
    slider,
  );
  await page.focus(slider);
  await page.keyboard.press("ArrowLeft");
  await when(page, (step) => spherule.session.newest.step === step && !spherule.seeking, before);
  const paused = await page.evaluate(() => spherule.session.settings.paused);
  assert.equal(paused, false);
  const { step } = await queryServer(page);
  await page.waitForTimeout(300);
  assert.ok((await queryServer(page)).step > step);
  assert.equal(await page.evaluate(() => spherule.session.newest.step), before, "the past is paused");
  await page.click(control("pause"));
  await when(page, (then) => spherule.session.newest.step > then + 5, before);
});

test("the key End, the button Live and the right end of the timeline return to the present", async () => {
  for (const back of [
    () => page.focus(control("picture")).then(() => page.keyboard.press("End")),
    () => page.focus(slider).then(() => page.keyboard.press("End")),
    () => page.click(control("present")),
    () => pressAt(1.02),
    () => page.click(control("retry")),
  ]) {
    await hasPast(3);
    await pressAt(0.3);
    await showsPast();
    await back();
    await showsPresent();
    const { step } = await queryServer(page);
    await when(page, (least) => spherule.session.newest.step >= least, step);
    await says(page, "connection", /connected/);
  }
});

test("a handle that is dragged follows the pointer, to the past and back to the present", async () => {
  await hasPast(6);
  const { x, y, width, height } = await page.locator(slider).boundingBox();
  const middle = y + height / 2;
  await page.mouse.move(x + width - 8, middle);
  await page.mouse.down();
  await page.mouse.move(x + width / 2, middle, { steps: 8 });
  await when(page, () => spherule.session.replay !== undefined && !spherule.seeking);
  const ago = await page.evaluate(() => spherule.session.past.end - spherule.session.newest.at);
  assert.ok(ago > 2, `${ago} s ago`);
  await page.mouse.move(x + width + 30, middle, { steps: 8 });
  await showsPresent();
  await page.mouse.up();
  await showsPresent();
});

test("a command acts on the present, to which the page returns, and the page says so", async () => {
  await hasPast(4);
  await pressAt(0.3);
  await showsPast();
  await page.selectOption(control("gravity-preset"), "Moon");
  await showsPresent();
  await when(page, () => document.querySelector('[data-testid="toasts"]').textContent.includes("Live again"));
  await when(page, () => spherule.session.settings.gravity[2] === -1.62);
  assert.deepEqual((await queryServer(page)).settings.gravity, [0, 0, -1.62]);
  await page.selectOption(control("gravity-preset"), "Zero");
  await when(page, () => spherule.session.settings.gravity.every((part) => part === 0));
});

test("spheres that came later are not in the past, and come again when it is played", async () => {
  await hasPast(4);
  const before = await page.evaluate(() => spherule.spheres);
  await page.fill(control("drop-count"), "3");
  await page.press(control("drop-count"), "Enter");
  await page.click(control("drop"));
  await when(page, (count) => spherule.spheres === count + 3, before);
  const { begin, end } = await page.evaluate(() => spherule.session.past);
  await page.waitForTimeout(1500);
  await pressAt(Math.max(0.05, (end - begin - 1) / (end - begin + 1.5)));
  await when(page, (count) => spherule.session.replay && spherule.spheres === count, before);
  await when(page, (count) => spherule.session.replay && spherule.spheres === count + 3, before);
  const positions = await page.evaluate((id) => spherule.positions([id]).positions, before + 2);
  assert.equal(positions[0]?.length, 3, "the new spheres have ids and positions");
  await page.click(control("present"));
  await showsPresent();
  assert.equal(await page.evaluate(() => spherule.spheres), before + 3);
});

test("a scene that was left is in the past, and its end is followed by the new scene", async () => {
  const other = await serve(gas);
  const watcher = await open(suite.browser, other.url, { size: [960, 720] });
  await hasPast(4, watcher);
  await chooseScene(watcher, "cradle");
  await when(watcher, () => spherule.session.facts.name === "cradle" && spherule.session.newest);
  await watcher.waitForTimeout(1000);
  await pressAt(0.1, watcher);
  const showsGas = () => spherule.session.replay && spherule.session.facts.name === "gas" && spherule.spheres === 24;
  await when(watcher, showsGas);
  await watcher.focus(slider);
  await when(watcher, () => spherule.session.replay && spherule.session.facts.name === "cradle");
  await watcher.keyboard.press("End");
  await showsPresent(watcher);
  assert.equal(await watcher.evaluate(() => spherule.session.facts.name), "cradle");
  assert.deepEqual(watcher.faults, []);
  await watcher.close();
  await other.stop();
});

test("viewers without control can look back, also when the server is gone", async () => {
  const tokens = { viewer: "only-for-watching-0123456789", controller: "to-steer-it-0123456789abcdef" };
  const guarded = await serve(gas, { tokens });
  const watcher = await visit(suite.browser, guarded.url, { size: [960, 720] });
  await watcher.fill(control("token-field"), tokens.viewer);
  await watcher.click(control("token-connect"));
  await hasPast(4, watcher);
  await pressAt(0.5, watcher);
  await showsPast(watcher);
  await watcher.click(control("pause"));
  await when(watcher, () => spherule.session.paused);
  assert.equal(await watcher.isDisabled(control("reset")), true);
  await watcher.click(control("present"));
  await showsPresent(watcher);
  await guarded.kill();
  await when(watcher, () => spherule.session.link !== "open");
  await pressAt(0.3, watcher);
  await showsPast(watcher);
  const step = await watcher.evaluate(() => spherule.session.newest.step);
  await when(watcher, (then) => spherule.session.newest.step > then, step);
  await watcher.close();
});

/** The positions in an exported CSV file, by time (s) and id. */
async function exported(file) {
  const csv = path.join(suite.folder, "saved.csv");
  await spherule("export", file, "--format", "csv", "--out", csv, "--force");
  const states = new Map();
  for (const line of (await readFile(csv, "utf8")).trim().split("\n").slice(1)) {
    const [time, id, ...rest] = line.split(",").map(Number);
    if (!states.has(time)) states.set(time, []);
    states.get(time)[id] = rest.slice(0, 3);
  }
  return states;
}

test("the last seconds are saved as a recording that the program plays and exports", async () => {
  const own = await serve(gas);
  const watcher = await open(suite.browser, own.url, { size: [1280, 720], colour: "id" });
  await logStates(watcher);
  await hasPast(5, watcher);
  const [download] = await Promise.all([watcher.waitForEvent("download"), watcher.click(control("save"))]);
  assert.match(download.suggestedFilename(), /^gas-\d{8}-\d{6}\.sph$/);
  const file = path.join(suite.folder, download.suggestedFilename());
  await download.saveAs(file);
  const seen = await evaluateLarge(watcher, () => [...window.seen].map(([time, positions]) => ({ time, positions })));
  const quantum = await watcher.evaluate(() => spherule.positions([0]).quantum);
  const states = await exported(file);
  assert.ok(states.size > 60, `${states.size} states`);
  const shared = seen.filter(({ time }) => [...states.keys()].some((one) => Math.abs(one - time) < 1e-9));
  assert.ok(shared.length > 20, `${shared.length} of ${seen.length} states are in the file`);
  for (const { time, positions } of shared) {
    const [, saved] = [...states].find(([one]) => Math.abs(one - time) < 1e-9);
    assert.equal(saved.length, positions.length);
    positions.forEach((place, id) => {
      place.forEach((value, axis) => assert.ok(Math.abs(value - saved[id][axis]) < quantum / 100, `${time} s, ${id}`));
    });
  }
  assert.deepEqual(watcher.faults, []);
  await watcher.close();
  await own.stop();
  const player = await play(file, { options: ["--paused"] });
  const viewer = await open(suite.browser, player.url, { size: [960, 540] });
  const { frames, flaw } = await viewer.evaluate(() => spherule.session.timeline);
  assert.deepEqual([Number(frames), flaw], [states.size, ""]);
  assert.equal(await viewer.evaluate(() => spherule.session.facts.name), "gas");
  await viewer.close();
  await player.stop();
});

test("nothing overlaps while the past is shown", async () => {
  await hasPast(3);
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    for (const shown of [false, true]) {
      await showPanel(page, shown);
      await pressAt(0.4);
      await showsPast();
      assert.deepEqual(await collisions(page, 5), [], `${width} x ${height}`);
    }
  }
  await page.setViewportSize({ width: 1280, height: 720 });
  assert.deepEqual(page.faults, []);
});
