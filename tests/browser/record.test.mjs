// Recordings in the page: files that the page plays without a server.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { control, open, says, visit, when } from "./support/browser.mjs";
import { gasScene } from "./support/gas.mjs";
import { collisions, showPanel, sizes } from "./support/layout.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve, spherule } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const slider = control("timeline");
const duration = 4; // s
const spacing = 1 / 30; // s

let file;
let server;
let page;
const suite = browserSuite(async (browser, folder) => {
  file = path.join(folder, "gas.sph");
  const scene = await gasScene(folder);
  const options = ["--for", `${duration}s`, "--record", file, "--record-tier", "normal", "--device", "cpu"];
  await spherule("run", scene, ...options);
  server = await serve("cradle");
  page = await open(browser, server.url, { size: [1280, 720], colour: "id" });
});

/** Chooses a file with the button of the panel. */
async function choose(which) {
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.click(control("open-file"))]);
  await chooser.setFiles(which);
}

/** Drops a file on the page. */
async function drop(name, bytes) {
  const data = await page.evaluateHandle(
    ([base64, called]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], called));
      return transfer;
    },
    [bytes.toString("base64"), name],
  );
  for (const kind of ["dragover", "drop"]) await page.dispatchEvent(".page", kind, { dataTransfer: data });
}

const plays = (name) =>
  when(
    page,
    (wanted) => spherule.session.replay?.source === "file" && spherule.session.timeline?.file === wanted,
    name,
  );

async function backToLive() {
  await page.click(control("present"));
  const isLive = () => spherule.session.facts.name === "cradle" && spherule.session.newest && !spherule.session.replay;
  await when(page, isLive);
}

/** Pauses the playback at a time (s). */
async function pauseAt(time) {
  if (!(await page.evaluate(() => spherule.session.paused))) await page.click(control("pause"));
  await when(page, () => spherule.session.paused);
  const { x, y, width, height } = await page.locator(slider).boundingBox();
  await page.mouse.click(x + 8 + (time / duration) * (width - 16), y + height / 2);
  const isThere = ([wanted, most]) => !spherule.seeking && Math.abs(spherule.session.newest.simTime - wanted) < most;
  await when(page, isThere, [time, 0.05 + spacing]);
}

/** The last toast with bad news. */
const complaint = async (pattern) => {
  const toast = page.locator('[data-testid="toast"][data-tone="bad"]').filter({ hasText: pattern });
  await toast.last().waitFor();
  return toast.last().textContent();
};

test("a chosen file is played in the page, with its positions, and the server never sees it", async () => {
  const sessions = await server.metric("spherule_sessions");
  await choose(file);
  await plays("gas.sph");
  await says(page, "connection", /a file/);
  assert.equal(await page.textContent(control("scene-name")), "gas");
  assert.equal(await page.textContent(control("timeline-file")), "gas.sph");
  await when(page, () => spherule.session.newest.simTime > 0.2); // it plays
  const { begin, end, frames, flaw } = await page.evaluate(() => {
    const { begin, end, frames, flaw } = spherule.session.timeline;
    return { begin, end, frames: Number(frames), flaw };
  });
  assert.deepEqual([begin, frames, flaw], [0, 121, ""]);
  assert.ok(Math.abs(end - duration) < 1e-6);
  await pauseAt(2.5);
  const shown = await page.evaluate(() => {
    const ids = [...Array(spherule.spheres).keys()];
    return { time: spherule.session.newest.simTime, ...spherule.positions(ids) };
  });
  const csv = file.replace(".sph", ".csv");
  const range = ["--from", `${shown.time - 1e-4}s`, "--to", `${shown.time + 1e-4}s`];
  await spherule("export", file, "--format", "csv", "--out", csv, "--force", ...range);
  const rows = (await readFile(csv, "utf8"))
    .trim()
    .split("\n")
    .slice(1)
    .map((row) => row.split(",").map(Number));
  assert.equal(rows.length, 24);
  for (const [, id, ...place] of rows) {
    shown.positions[id].forEach((value, axis) => {
      assert.ok(Math.abs(value - place[axis]) < shown.quantum / 100, `sphere ${id}: ${value}, ${place[axis]}`);
    });
  }
  assert.ok(sessions > 0);
  await when(page, () => spherule.session.link === "open");
  assert.equal(await server.metric("spherule_sessions"), sessions - 1, "the page has left the server");
  await backToLive();
  assert.equal((await queryServer(page)).positions.length, 5);
});

test("pause, steps, keys, speed and the end of the file work as in a server's recording", async () => {
  await choose(file);
  await plays("gas.sph");
  await pauseAt(1);
  const first = await page.evaluate(() => spherule.session.newest.simTime);
  await page.click(control("step"));
  await when(page, (time) => Math.abs(spherule.session.newest.simTime - time) < 1e-6, first + spacing);
  await page.focus(control("picture"));
  await page.keyboard.press("r");
  await when(page, () => spherule.session.newest.simTime === 0);
  const ofSimulations = ["scenes", "save-scene", "edit-scene", "drop", "tool", "record", "save"];
  for (const id of ofSimulations) assert.equal(await page.isVisible(control(id)), false, id);
  await page.fill(control("speed"), "4");
  await page.press(control("speed"), "Enter");
  await when(page, () => spherule.session.settings.speed === 4);
  await page.focus(control("picture"));
  await page.keyboard.press(" ");
  const hasEnded = (end) => spherule.session.paused && Math.abs(spherule.session.newest.simTime - end) < 1e-6;
  await when(page, hasEnded, duration);
  await page.click(control("pause"));
  await when(page, () => !spherule.session.paused && spherule.session.newest.simTime < 3);
  await page.fill(control("speed"), "5000");
  await page.press(control("speed"), "Enter");
  assert.equal(await page.evaluate(() => spherule.session.settings.speed), 4, "a wrong speed changes nothing");
  await page.press(control("speed"), "Escape");
  await backToLive();
});

test("a dropped file is played, also while the server is away, and the page finds back to it", async () => {
  await drop("gas.sph", await readFile(file));
  await plays("gas.sph");
  const { port } = server;
  await server.stop();
  await pauseAt(3);
  server = await serve("cradle", { port });
  await backToLive();
  assert.deepEqual(
    page.faults.filter((fault) => !/WebSocket|ERR_CONNECTION/.test(fault)),
    [],
  );
});

test("foreign and damaged files are refused with what is wrong and where, and the simulation stays", async () => {
  const whole = await readFile(file);
  await drop("notes.txt", Buffer.from("hello"));
  assert.match(await complaint("notes.txt"), /This page opens recordings \(\.sph\)/);
  await drop("foreign.sph", Buffer.from("PNG, but not a recording"));
  assert.match(await complaint("foreign.sph"), /Is no recording/);
  await drop("stub.sph", whole.subarray(0, 700));
  assert.match(await complaint("stub.sph"), /no frames: the record at byte \d+ is cut off/);
  assert.equal(await page.evaluate(() => spherule.session.replay), undefined);
  assert.equal(await page.evaluate(() => spherule.session.facts.name), "cradle");
});

test("a recording of the server can be downloaded and opened at its end, and nothing else can", async () => {
  const tokens = { viewer: "only-for-watching-0123456789", controller: "to-steer-it-0123456789abcdef" };
  const folder = path.dirname(file);
  const guarded = await serve(path.join(folder, "gas.json"), { tokens, folder });
  const live = await visit(suite.browser, guarded.url, { size: [1280, 720] });
  await live.fill(control("token-field"), tokens.controller);
  await live.click(control("token-connect"));
  await when(live, () => spherule.session.frames > 0);
  await live.click(control("record"));
  await when(live, () => spherule.session.recording.active && spherule.session.recording.duration > 0.5);
  await live.click(control("record"));
  const [download] = await Promise.all([live.waitForEvent("download"), live.click(control("toast-download"))]);
  const name = download.suggestedFilename();
  assert.match(name, /^gas-\d{8}-\d{6}\.sph$/);
  const written = await readFile(path.join(folder, "recordings", name));
  assert.deepEqual(await readFile(await download.path()), written);
  const get = async (target, token) => {
    const headers = token ? { Authorization: `Bearer ${token}` } : {};
    return (await fetch(new URL(target, guarded.url), { headers })).status;
  };
  const target = `recordings/${name}`;
  const statuses = [get(target), get(target, "no-such-token-0123456789"), get(target, tokens.viewer)];
  assert.deepEqual(await Promise.all(statuses), [401, 401, 200]);
  await writeFile(path.join(folder, "recordings", "other.sph"), written); // not by this server
  const others = ["recordings/other.sph", "recordings/..%2Fgas.json", `recordings/${name}x`, "recordings/"];
  for (const other of others) assert.equal(await get(other, tokens.controller), 404, other);
  await live.click(control("record"));
  await when(live, () => spherule.session.recording.active && spherule.session.recording.duration > 0.5);
  await live.click(control("record"));
  await live.click(control("toast-open"));
  await when(live, () => spherule.session.replay?.source === "file" && spherule.spheres === 24);
  await says(live, "timeline-file", /^gas-.*\.sph$/);
  assert.deepEqual(live.faults, []);
  await live.close();
  await guarded.stop();
});

test("a file that was cut off plays up to the cut, and damage inside is told and left out", async () => {
  const whole = await readFile(file);
  await drop("cut.sph", whole.subarray(0, Math.floor(0.6 * whole.length)));
  await plays("cut.sph");
  await says(page, "timeline-flaw", /Ends early: the record at byte \d+ is cut off/);
  assert.ok(await page.evaluate((most) => spherule.session.timeline.end < most, 0.9 * duration));
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    for (const shown of [false, true]) {
      await showPanel(page, shown);
      assert.deepEqual(await collisions(page, 5), [], `${width} x ${height}`);
    }
  }
  const damaged = Buffer.from(whole);
  damaged[Math.floor(0.3 * whole.length)] ^= 0x55;
  await drop("damaged.sph", damaged);
  await plays("damaged.sph");
  assert.match(await complaint("Damage in damaged.sph"), /record at byte \d+ is damaged: its checksum differs/);
  const { end, frames } = await page.evaluate(() => ({
    end: spherule.session.timeline.end,
    frames: Number(spherule.session.timeline.frames),
  }));
  assert.ok(Math.abs(end - duration) < 1e-6 && frames < 121 && frames > 40, `${frames} frames`);
  await backToLive();
  const bad = path.join(path.dirname(file), "bad.sph");
  await writeFile(bad, damaged);
  await choose(bad);
  await plays("bad.sph");
  await backToLive();
});
