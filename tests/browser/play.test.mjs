import assert from "node:assert/strict";
import { readdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { control, evaluateLarge, open, says, unfold, when } from "./support/browser.mjs";
import { collisionsByWidth } from "./support/layout.mjs";
import { queryServer } from "./support/raw.mjs";
import { play, serve, spherule } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const duration = 3.9; // s
const frame = 1 / 30; // s

let file;
let page; // of a server that plays a recording
const suite = browserSuite(async (browser, folder) => {
  file = path.join(folder, "cradle.sph");
  await spherule("run", "cradle", "--for", `${duration}s`, "--record", file, "--device", "cpu");
  page = await open(browser, (await play(file, { options: ["--paused"] })).url, { size: [1280, 900] });
});

const slider = control("timeline");

/** The point of the page at which the handle is for this share of the timeline. */
async function placeOf(share) {
  const { x, y, width, height } = await page.locator(slider).boundingBox();
  return [x + 8 + share * (width - 16), y + height / 2];
}

/** The time at the handle (s). */
const handleTime = () => page.locator(slider).evaluate((element) => element.valueAsNumber);

/** The simulated time of the newest state (s). */
const newestTime = () => page.evaluate(() => spherule.session.newest.simTime);

/** Waits until the newest state has this time (s), to within `tolerance`, and image and handle show it. */
async function at(time, tolerance = 2 * frame) {
  await when(
    page,
    ([wanted, most, selector]) => {
      const { simTime } = spherule.session.newest;
      const handle = document.querySelector(selector).valueAsNumber;
      return (
        !spherule.seeking &&
        Math.abs(simTime - wanted) <= most &&
        spherule.shown.time === simTime &&
        Math.abs(handle - simTime) < 1e-9
      );
    },
    [time, tolerance, slider],
  ).catch(async (error) => {
    const { seeking, shown } = await page.evaluate(() => ({ seeking: spherule.seeking, shown: spherule.shown }));
    const state = { seeking, shown, newest: await newestTime(), handle: await handleTime() };
    throw new Error(`not at ${time}: ${JSON.stringify(state)}`, { cause: error });
  });
}

/** Waits until playback is between these times (s), and no seek is in progress. */
async function playsBetween(low, high) {
  await when(
    page,
    ([from, to]) => {
      const { simTime } = spherule.session.newest;
      return simTime > from && simTime < to && !spherule.seeking && !spherule.session.paused;
    },
    [low, high],
  );
}

/** To pause, set a low speed first: at the end playback pauses by itself, and then the button starts it again. */
async function setPaused(wanted) {
  if ((await page.evaluate(() => spherule.session.paused)) !== wanted) await page.click(control("pause"));
  await when(page, (paused) => spherule.session.paused === paused, wanted);
}

test("the page shows the recording, and hides controls without effect", async () => {
  const { timeline, recording, drawn } = await page.evaluate(() => {
    const { file, begin, end, frames, flaw } = spherule.session.timeline;
    const timeline = { file, begin, end, frames: Number(frames), flaw };
    return { timeline, recording: spherule.session.recording, drawn: spherule.drawn };
  });
  assert.deepEqual([timeline.file, timeline.begin, timeline.frames, timeline.flaw], ["cradle.sph", 0, 118, ""]);
  assert.ok(Math.abs(timeline.end - duration) < 1e-6);
  assert.equal(recording, undefined);
  assert.ok(drawn > 0);
  await unfold(page, "Stream");
  await page.locator(control("rate")).waitFor();
  for (const id of ["pause", "step", "step-many", "reset", "speed", "colour", "tier", "rate", "timeline"]) {
    assert.equal(await page.isVisible(control(id)), true, id);
  }
  const world = ["scenes", "dial", "auto", "gravity-preset", "restitution", "friction", "drop", "tool"];
  for (const id of [...world, "record", "timeline-flaw"]) assert.equal(await page.isVisible(control(id)), false, id);
  assert.match(await page.textContent(control("help-overlay")), /to the beginning/);
  assert.doesNotMatch(await page.textContent(control("help-overlay")), /drop|push/);
});

test("a click on the timeline seeks at once, and no state in between is shown", async () => {
  await setPaused(true);
  await page.click(control("reset"));
  await at(0);
  await page.keyboard.press("3"); // a colour mode without speeds
  await page.evaluate((selector) => {
    window.seen = [];
    const sample = () => {
      const handle = document.querySelector(selector).valueAsNumber;
      window.seen.push({ handle, image: spherule.shown.time });
      requestAnimationFrame(sample);
    };
    sample();
  }, slider);
  await page.mouse.click(...(await placeOf(0.75)));
  await at(0.75 * duration);
  const seen = await page.evaluate(() => window.seen);
  assert.deepEqual(
    seen.filter(({ image }) => image > 3 * frame && image < 0.75 * duration - 3 * frame),
    [],
  );
  const moved = seen.findIndex(({ handle }) => handle > 0.7 * duration);
  assert.deepEqual(
    seen.slice(moved).filter(({ handle }) => handle < 0.7 * duration),
    [],
  );
  const { from, to } = await page.evaluate(() => spherule.shown);
  assert.equal(from, to); // no motion from the earlier state
  const { step, positions, quantum } = await queryServer(page);
  const shown = await evaluateLarge(page, (ids) => spherule.positions(ids), [...positions.keys()]);
  assert.equal(shown.step, step);
  shown.positions.forEach((position, id) => {
    position.forEach((x, axis) => assert.ok(Math.abs(x - positions[id][axis]) <= quantum, `sphere ${id}`));
  });
});

test("with speeds shown, a seek while paused also brings the previous frame", async () => {
  await setPaused(true);
  await page.keyboard.press("1");
  await page.mouse.click(...(await placeOf(0.25)));
  await at(0.25 * duration);
  const { from, to } = await page.evaluate(() => spherule.shown);
  assert.ok(Math.abs(to - from - frame) < 1e-6, `${from} ${to}`);
});

test("the handle stays under the pointer while it is dragged, and the image follows", async () => {
  await setPaused(true);
  await page.mouse.move(...(await placeOf(0.5)));
  await page.mouse.down();
  for (let share = 0.5; share > 0.2; share -= 0.01) {
    await page.mouse.move(...(await placeOf(share)));
    const time = await handleTime();
    assert.ok(Math.abs(time - share * duration) < 0.05, `${time} for ${share * duration}`);
  }
  const between = Math.floor((0.2 * duration) / frame) + 0.5; // frames: the image shows the earlier one
  await page.mouse.move(...(await placeOf((between * frame) / duration)));
  await when(
    page,
    (wanted) => !spherule.seeking && Math.abs(spherule.session.newest.simTime - wanted) < 1e-6,
    (between - 0.5) * frame,
  );
  const time = await handleTime();
  assert.ok(Math.abs(time - between * frame) < 0.4 * frame, `${time} for ${between * frame}`);
  const [x, y] = await placeOf(0.2);
  await page.mouse.move(x, y + 60); // the pointer may leave the timeline
  await when(page, (most) => spherule.session.newest.simTime < most, 0.3 * duration);
  await page.mouse.up();
  await at(0.2 * duration);
  assert.ok(Math.abs((await handleTime()) - 0.2 * duration) <= 2 * frame);
});

/** Sets the speed of playback on the panel. */
async function setSpeed(speed) {
  await page.fill(control("speed"), String(speed));
  await page.press(control("speed"), "Enter");
  await when(page, (wanted) => spherule.session.settings.speed === wanted, speed);
}

test("playback continues where the handle is released", async () => {
  await setSpeed(0.1); // so that a busy machine does not reach the end before the release
  await setPaused(false);
  await page.mouse.move(...(await placeOf(0.9)));
  await page.mouse.down();
  await page.mouse.move(...(await placeOf(0.1)), { steps: 20 });
  await page.mouse.up();
  await playsBetween(0.1 * duration + 2 * frame, 0.8 * duration);
  assert.equal(await page.evaluate(() => spherule.session.paused), false);
  await setPaused(true);
  await setSpeed(1);
});

test("pause, single frames and resume", async () => {
  await setSpeed(0.1);
  await setPaused(true);
  await page.mouse.click(...(await placeOf(0.5)));
  await at(0.5 * duration);
  const before = await newestTime();
  await page.click(control("step"));
  await at(before + frame, 1e-6);
  await page.click(control("step-many"));
  await at(before + 11 * frame, 1e-6);
  await page.waitForTimeout(300);
  await at(before + 11 * frame, 1e-6);
  await page.click(control("pause"));
  await when(page, (then) => spherule.session.newest.simTime > then, before + 12 * frame);
  await setPaused(true);
  await setSpeed(1);
});

test("reset goes to the beginning, by button and by key", async () => {
  await setPaused(true);
  for (const press of [() => page.click(control("reset")), () => page.keyboard.press("r")]) {
    await page.mouse.click(...(await placeOf(0.2))); // far from the handle: a click on it is no seek
    await at(0.2 * duration);
    await press();
    await at(0, 1e-9);
  }
});

test("keys move the focused handle", async () => {
  await setPaused(true);
  const { azimuth } = await page.evaluate(() => spherule.camera);
  await page.focus(slider);
  await page.keyboard.press("End");
  await at(duration, 1e-6);
  await page.keyboard.press("Home");
  await at(0, 1e-9);
  for (const [key, frames] of [
    ["ArrowRight", [1, 2, 3]],
    ["ArrowLeft", [2, 1]],
  ]) {
    for (const number of frames) {
      await page.keyboard.press(key);
      await at(number * frame, 1e-6);
    }
  }
  await page.keyboard.press("PageUp");
  await at(0.1 * duration + frame, frame);
  assert.match(await page.getAttribute(slider, "aria-valuetext"), /^0\.4\d s of 3\.90 s$/);
  assert.equal((await page.evaluate(() => spherule.camera)).azimuth, azimuth);
  await page.keyboard.press(" ");
  await when(page, () => !spherule.session.paused);
});

test("playback pauses at the end, and resumes from the beginning", async () => {
  await setPaused(false);
  await page.mouse.click(...(await placeOf(0.9)));
  await when(
    page,
    (end) => spherule.session.paused && Math.abs(spherule.session.newest.simTime - end) < 1e-6,
    duration,
  );
  await page.click(control("pause"));
  await playsBetween(2 * frame, 0.9 * duration);
});

test("the speed set on the panel is the speed of playback", async () => {
  await setSpeed(0.5);
  assert.equal((await queryServer(page)).settings.speed, 0.5);
  assert.deepEqual(page.faults, []);
});

test("an incomplete recording is marked, and no element covers another one", async () => {
  const cut = path.join(suite.folder, "cut.sph");
  const whole = await readFile(file);
  await writeFile(cut, whole.subarray(0, Math.round(0.6 * whole.length)));
  const other = await open(suite.browser, (await play(cut, { options: ["--paused"] })).url, { size: [1280, 900] });
  const { end, flaw } = await other.evaluate(() => {
    const { end, flaw } = spherule.session.timeline;
    return { end, flaw };
  });
  assert.ok(end > 0 && end < duration && flaw);
  await other.waitForSelector(control("timeline-flaw"));
  assert.ok((await other.textContent(control("timeline-flaw"))).includes(flaw));
  for (const { width, faults } of await collisionsByWidth(other, 6)) assert.deepEqual(faults, [], `${width} px`);
  await other.close();
});

test("the record button records the simulation to a readable file", async () => {
  const server = await serve("cradle", { folder: suite.folder });
  const live = await open(suite.browser, server.url, { size: [1280, 900] });
  await live.waitForSelector(".timeline.of-simulation");
  await live.click(control("record"));
  await when(live, () => {
    const { active, duration, bytes } = spherule.session.recording;
    return active && duration > 0.5 && bytes > 0;
  });
  await live.waitForSelector(`${control("record")}[aria-pressed="true"]`);
  await says(live, "record-words", /^0:\d\d · [\d.]+ [kM]B$/);
  for (const { width, faults } of await collisionsByWidth(live, 5)) assert.deepEqual(faults, [], `${width} px`);
  await live.click(control("record"));
  await when(live, () => !spherule.session.recording.active);
  const recorded = await live.evaluate(() => spherule.session.recording.file);
  const toast = live.locator(control("toast")).filter({ hasText: "Recorded" });
  assert.ok((await toast.textContent()).includes(`spherule play ${recorded}`));
  assert.deepEqual(await readdir(path.join(suite.folder, "recordings")), [path.basename(recorded)]);
  const states = path.join(suite.folder, "states.csv");
  await spherule("export", path.join(suite.folder, recorded), "--format", "csv", "--out", states);
  const rows = (await readFile(states, "utf8")).trim().split("\n");
  assert.equal(rows[0], "time,id,x,y,z,radius,group,material");
  assert.ok(rows.length > 1 + 5 * 10, `${rows.length} rows`);
  assert.deepEqual(live.faults, []);
  await live.close();
});
