import assert from "node:assert/strict";
import { mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { control, launch, open, when } from "./support/browser.mjs";
import { collisionsByWidth } from "./support/layout.mjs";
import { serverSays } from "./support/raw.mjs";
import { play, serve, spherule, stopAll } from "./support/server.mjs";

const lasts = 3.9; // s
const frame = 1 / 30;

let folder;
let file;
let browser;
let page; // of a recording that is played
before(async () => {
  folder = await mkdtemp(path.join(tmpdir(), "spherule-play-"));
  file = path.join(folder, "cradle.sph");
  await spherule("run", "cradle", "--for", `${lasts}s`, "--record", file, "--device", "cpu");
  browser = await launch();
  page = await open(browser, (await play(file, { options: ["--paused"] })).url, { size: [1280, 900] });
});
after(async () => {
  await browser?.close();
  await stopAll();
  await rm(folder, { recursive: true, force: true });
});

const slider = control("timeline");

/** Where on the page the handle stands for that share of the timeline. */
async function placeOf(share) {
  const { x, y, width, height } = await page.locator(slider).boundingBox();
  return [x + 8 + share * (width - 16), y + height / 2];
}

/** Waits until the page has the moment, to within `off` s, and picture and handle show it. */
async function at(time, off = 2 * frame) {
  await when(
    page,
    ([wanted, most]) =>
      !spherule.timeline.seeking &&
      Math.abs(spherule.simTime - wanted) <= most &&
      spherule.shown.time === spherule.simTime &&
      Math.abs(spherule.timeline.time - spherule.simTime) < 1e-9,
    [time, off],
  ).catch(async (error) => {
    const is = await page.evaluate(() => ({ timeline: spherule.timeline, simTime: spherule.simTime, shown: spherule.shown }));
    throw new Error(`not at ${time}: ${JSON.stringify(is)}`, { cause: error });
  });
}

async function setPaused(wanted) {
  if ((await page.evaluate(() => spherule.paused)) !== wanted) await page.click(control("pause"));
  await when(page, (paused) => spherule.paused === paused, wanted);
}

test("the page says what is played and offers only what works", async () => {
  const { timeline, recording, drawn } = await page.evaluate(() => ({ ...spherule, drawn: spherule.picture.drawn }));
  assert.deepEqual([timeline.file, timeline.begin, timeline.frames, timeline.flaw], ["cradle.sph", 0, 118, ""]);
  assert.ok(Math.abs(timeline.end - lasts) < 1e-6);
  assert.equal(recording, undefined);
  assert.ok(drawn > 0);
  for (const id of ["pause", "step", "step-many", "reset", "speed", "colour", "tier", "rate", "timeline"])
    assert.equal(await page.isVisible(control(id)), true, id);
  for (const id of ["scene", "dial", "auto", "gravity-preset", "restitution", "friction", "drop", "push", "record", "timeline-flaw"])
    assert.equal(await page.isVisible(control(id)), false, id);
  assert.match(await page.textContent(control("help-overlay")), /to the beginning/);
  assert.doesNotMatch(await page.textContent(control("help-overlay")), /drop|push/);
});

test("a click on the timeline goes there at once, and nothing is shown in between", async () => {
  await setPaused(true);
  await page.click(control("reset"));
  await at(0);
  await page.keyboard.press("3"); // no speeds are shown
  await page.evaluate(() => {
    window.seen = [];
    const look = () => {
      window.seen.push({ handle: spherule.timeline.time, picture: spherule.shown.time });
      requestAnimationFrame(look);
    };
    look();
  });
  await page.mouse.click(...(await placeOf(0.75)));
  await at(0.75 * lasts);
  const seen = await page.evaluate(() => window.seen);
  assert.deepEqual(seen.filter(({ picture }) => picture > 3 * frame && picture < 0.75 * lasts - 3 * frame), []);
  const gone = seen.findIndex(({ handle }) => handle > 0.7 * lasts);
  assert.deepEqual(seen.slice(gone).filter(({ handle }) => handle < 0.7 * lasts), []);
  const { from, to } = await page.evaluate(() => spherule.shown);
  assert.equal(from, to); // nothing has moved from where it was before
  const { step, positions, quantum } = await serverSays(page);
  const shown = await page.evaluate((ids) => spherule.positions(ids), [...positions.keys()]);
  assert.equal(shown.step, step);
  shown.positions.forEach((place, id) => place.forEach((x, axis) => assert.ok(Math.abs(x - positions[id][axis]) <= quantum, `sphere ${id}`)));
});

test("where speeds are shown, a moment that stands still comes with the one before it", async () => {
  await setPaused(true);
  await page.keyboard.press("1");
  await page.mouse.click(...(await placeOf(0.25)));
  await at(0.25 * lasts);
  const { from, to } = await page.evaluate(() => spherule.shown);
  assert.ok(Math.abs(to - from - frame) < 1e-6, `${from} ${to}`);
});

test("the handle stays under the pointer while it is dragged, and the picture follows", async () => {
  await setPaused(true);
  await page.mouse.move(...(await placeOf(0.5)));
  await page.mouse.down();
  for (let share = 0.5; share > 0.2; share -= 0.01) {
    await page.mouse.move(...(await placeOf(share)));
    const { time } = await page.evaluate(() => spherule.timeline);
    assert.ok(Math.abs(time - share * lasts) < 0.05, `${time} for ${share * lasts}`);
  }
  const between = Math.floor((0.2 * lasts) / frame) + 0.5; // of two frames: the picture shows the first, the handle stays
  await page.mouse.move(...(await placeOf((between * frame) / lasts)));
  await when(page, (then) => !spherule.timeline.seeking && Math.abs(spherule.simTime - then) < 1e-6, (between - 0.5) * frame);
  const { time } = await page.evaluate(() => spherule.timeline);
  assert.ok(Math.abs(time - between * frame) < 0.4 * frame, `${time} for ${between * frame}`);
  const [x, y] = await placeOf(0.2);
  await page.mouse.move(x, y + 60); // the pointer may leave the bar
  await when(page, (most) => spherule.simTime < most, 0.3 * lasts);
  await page.mouse.up();
  await at(0.2 * lasts);
  assert.ok(Math.abs((await page.evaluate(() => spherule.timeline.time)) - 0.2 * lasts) <= 2 * frame);
});

test("while it plays, what is dragged to is where it goes on", async () => {
  await setPaused(false);
  await page.mouse.move(...(await placeOf(0.9)));
  await page.mouse.down();
  await page.mouse.move(...(await placeOf(0.1)), { steps: 20 });
  await page.mouse.up();
  await when(page, ([low, high]) => spherule.simTime > low && spherule.simTime < high && !spherule.timeline.seeking, [
    0.1 * lasts + 2 * frame,
    0.8 * lasts,
  ]);
  assert.equal(await page.evaluate(() => spherule.paused), false);
});

test("pause, frames and resume", async () => {
  await setPaused(true);
  await page.mouse.click(...(await placeOf(0.5)));
  await at(0.5 * lasts);
  const before = await page.evaluate(() => spherule.simTime);
  await page.click(control("step"));
  await at(before + frame, 1e-6);
  await page.click(control("step-many"));
  await at(before + 11 * frame, 1e-6);
  await page.waitForTimeout(300);
  await at(before + 11 * frame, 1e-6);
  await page.click(control("pause"));
  await when(page, (then) => spherule.simTime > then, before + 12 * frame);
});

test("reset goes to the beginning, from the bar and from the keyboard", async () => {
  await setPaused(true);
  for (const press of [() => page.click(control("reset")), () => page.keyboard.press("r")]) {
    await page.mouse.click(...(await placeOf(0.6)));
    await at(0.6 * lasts);
    await press();
    await at(0, 1e-9);
  }
});

test("the keyboard moves the handle that has the focus", async () => {
  await setPaused(true);
  const { azimuth } = await page.evaluate(() => spherule.camera);
  await page.focus(slider);
  await page.keyboard.press("End");
  await at(lasts, 1e-6);
  await page.keyboard.press("Home");
  await at(0, 1e-9);
  for (const [key, time] of [["ArrowRight", 1], ["ArrowRight", 2], ["ArrowRight", 3], ["ArrowLeft", 2], ["ArrowLeft", 1]]) {
    await page.keyboard.press(key);
    await at(time * frame, 1e-6);
  }
  await page.keyboard.press("PageUp");
  await at(0.1 * lasts + frame, frame);
  assert.match(await page.getAttribute(slider, "aria-valuetext"), /^0\.4\d s of 3\.90 s$/);
  assert.equal((await page.evaluate(() => spherule.camera)).azimuth, azimuth);
  await page.keyboard.press(" ");
  await when(page, () => !spherule.paused);
});

test("at the end it pauses, and goes on from the beginning", async () => {
  await setPaused(false);
  await page.mouse.click(...(await placeOf(0.9)));
  await when(page, (end) => spherule.paused && Math.abs(spherule.simTime - end) < 1e-6, lasts);
  await page.click(control("pause"));
  await when(page, ([low, high]) => spherule.simTime > low && spherule.simTime < high && !spherule.paused, [2 * frame, 0.9 * lasts]);
});

test("the speed of the panel is that of the player", async () => {
  await page.fill(control("speed"), "0.5");
  await page.press(control("speed"), "Enter");
  await when(page, () => spherule.settings.speed === 0.5);
  assert.equal((await serverSays(page)).settings.speed, 0.5);
  assert.deepEqual(page.faults, []);
});

test("a recording that was cut off says so, and nothing covers anything else", async () => {
  const cut = path.join(folder, "cut.sph");
  const whole = await readFile(file);
  await writeFile(cut, whole.subarray(0, Math.round(0.6 * whole.length)));
  const other = await open(browser, (await play(cut, { options: ["--paused"] })).url, { size: [1280, 900] });
  const { end, flaw } = await other.evaluate(() => spherule.timeline);
  assert.ok(end > 0 && end < lasts && flaw);
  await other.waitForSelector(control("timeline-flaw"));
  assert.ok((await other.textContent(control("timeline-flaw"))).includes(flaw));
  for (const { width, faults } of await collisionsByWidth(other, 6)) assert.deepEqual(faults, [], `${width} px`);
  await other.close();
});

test("the record button records what a server simulates, in a file that can be read", async () => {
  const server = await serve("cradle", { folder });
  const live = await open(browser, server.url, { size: [1280, 900] });
  assert.equal(await live.isVisible(slider), false);
  await live.click(control("record"));
  await when(live, () => spherule.recording.active && spherule.recording.duration > 0.5 && spherule.recording.bytes > 0);
  await live.waitForSelector(`${control("record")}[aria-pressed="true"]`);
  await when(live, () => /^0:\d\d · [\d.]+ [kM]B$/.test(document.querySelector('[data-testid="record-words"]').textContent));
  for (const { width, faults } of await collisionsByWidth(live, 5)) assert.deepEqual(faults, [], `${width} px`);
  await live.click(control("record"));
  await when(live, () => !spherule.recording.active);
  const recorded = await live.evaluate(() => spherule.recording.file);
  const toast = live.locator(control("toast")).filter({ hasText: "Recorded" });
  assert.ok((await toast.textContent()).includes(`spherule play ${recorded}`));
  assert.deepEqual(await readdir(path.join(folder, "recordings")), [path.basename(recorded)]);
  const states = path.join(folder, "states.csv");
  await spherule("export", path.join(folder, recorded), "--format", "csv", "--out", states);
  const rows = (await readFile(states, "utf8")).trim().split("\n");
  assert.equal(rows[0], "time,id,x,y,z,radius");
  assert.ok(rows.length > 1 + 5 * 10, `${rows.length} rows`);
  assert.deepEqual(live.faults, []);
  await live.close();
});
