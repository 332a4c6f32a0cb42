// The cost of an image on the page's own thread: uploads, drawing, memory.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { control, launch, open, pause, settled, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const spheres = Array.from({ length: 200 }, (_, k) => ({
  position: [(k % 10) * 0.2 + 0.1, (Math.floor(k / 10) % 10) * 0.2 + 0.1, Math.floor(k / 100) * 0.4 + 0.2],
  velocity: [Math.sin(k), Math.cos(k), Math.sin(3 * k)],
}));
const gas = {
  gravity: [0, 0, 0],
  bounds: { min: [0, 0, 0], max: [2, 2, 1] },
  materials: [{ restitution: 1 }],
  groups: [{ name: "gas", list: { spheres }, radius: { constant: 0.05 } }],
};

let server;
const suite = browserSuite(async (browser, folder) => {
  const file = path.join(folder, "gas.json");
  writeFileSync(file, JSON.stringify(gas));
  server = await serve(file);
});

/** Counts calls of the graphics device, and bytes of uploads except those of uniforms. */
function countCalls() {
  window.calls = { draws: 0, uploads: 0, ticks: 0 };
  const { prototype } = WebGL2RenderingContext;
  const wrap = (name, count) => {
    const original = prototype[name];
    prototype[name] = function (...given) {
      count(given);
      return original.apply(this, given);
    };
  };
  const uniforms = 0x8a11; // UNIFORM_BUFFER
  for (const name of ["drawArrays", "drawArraysInstanced"]) wrap(name, () => (window.calls.draws += 1));
  for (const name of ["texImage2D", "texSubImage2D"]) wrap(name, () => (window.calls.uploads += 1));
  for (const name of ["bufferData", "bufferSubData"]) {
    wrap(name, ([target]) => (window.calls.uploads += target === uniforms ? 0 : 1));
  }
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => {
    window.calls.ticks += 1;
    return request(callback);
  };
}

test("a camera that moves uploads nothing, and at rest nothing is drawn", async () => {
  const page = await open(suite.browser, server.url, { size: [320, 240], picture: "full", init: countCalls });
  await pause(page);
  await settled(page);
  const calls = () => page.evaluate(() => ({ ...window.calls, drawn: spherule.drawn }));
  const before = await calls();
  await page.focus(control("picture"));
  for (let k = 0; k < 6; k++) {
    await page.keyboard.press(["ArrowLeft", "ArrowUp", "+"][k % 3]);
    await when(page, (drawn) => spherule.drawn > drawn, (await calls()).drawn);
  }
  await settled(page);
  const moved = await calls();
  assert.ok(moved.drawn >= before.drawn + 6 && moved.draws > before.draws, "images were drawn");
  assert.equal(moved.uploads, before.uploads);
  await page.waitForTimeout(2000);
  const rested = await calls();
  assert.equal(rested.draws, moved.draws);
  assert.equal(rested.uploads, moved.uploads);
  assert.ok(rested.ticks - moved.ticks <= 12, `${rested.ticks - moved.ticks} ticks in 2 s`);
  assert.deepEqual(page.faults, []);
  await page.close();
});

/** Bytes that the profile holds, without the ones of messages' payloads and of the browser itself. */
function bytesIn({ head }) {
  const isPayload = ({ functionName, url }) => functionName.endsWith("onmessage") || url === "";
  const sum = (node) =>
    (isPayload(node.callFrame) ? 0 : node.selfSize) + node.children.reduce((total, child) => total + sum(child), 0);
  return sum(head);
}

test("an image of a moving world, from a moving camera, allocates at most 4 kB", async () => {
  // The compiler works sooner than usual: code that it has not compiled keeps numbers in memory.
  const browser = await launch("--js-flags=--interrupt-budget=2000 --interrupt-budget-for-maglev=1000");
  const page = await open(browser, server.url, { size: [160, 120] });
  await page.evaluate(() => {
    const turn = () => window.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    setInterval(turn, 50);
  });
  const images = () => page.evaluate(() => ({ drawn: spherule.drawn, frames: spherule.session.frames }));
  const pass = async (count) => {
    const { drawn, frames } = await images();
    await when(page, (least) => Math.max(spherule.drawn - least[0], spherule.session.frames - least[1]) >= least[2], [
      drawn,
      frames,
      count,
    ]);
  };
  await pass(200);
  const session = await page.context().newCDPSession(page);
  const all = { includeObjectsCollectedByMajorGC: true, includeObjectsCollectedByMinorGC: true };
  await session.send("HeapProfiler.startSampling", { samplingInterval: 512, ...all });
  const before = await images();
  await pass(100);
  const after = await images();
  const { profile } = await session.send("HeapProfiler.stopSampling");
  const count = Math.max(after.drawn - before.drawn, after.frames - before.frames);
  const each = bytesIn(profile) / count;
  assert.ok(each < 4096, `${each.toFixed(0)} bytes for each of ${count} images`);
  assert.deepEqual(page.faults, []);
  await browser.close();
});
