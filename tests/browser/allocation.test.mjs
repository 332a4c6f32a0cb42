// The memory that the page's own thread allocates for an image of a moving world, from a moving camera.
import assert from "node:assert/strict";
import { test } from "node:test";
import { control, open, when } from "./support/browser.mjs";
import { gasScene } from "./support/gas.mjs";
import { showPanel } from "./support/layout.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const warm = 900; // images until the compiler has done its work: code that it has not compiled keeps numbers in memory

/** Bytes that the profile holds, without the ones of messages' payloads and of the browser itself. */
function bytesIn({ head }) {
  const isPayload = ({ functionName, url }) => functionName.endsWith("onmessage") || url === "";
  const sum = (node) =>
    (isPayload(node.callFrame) ? 0 : node.selfSize) + node.children.reduce((total, child) => total + sum(child), 0);
  return sum(head);
}

let server;
const suite = browserSuite(async (browser, folder) => {
  server = await serve(await gasScene(folder));
});

/** Checks the bytes of an image. `arrange(page)` runs before the page moves. */
async function expectFrugal(arrange = () => {}) {
  const page = await open(suite.browser, server.url, { size: [160, 120] });
  await arrange(page);
  await page.evaluate(() => {
    const turn = () => window.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    setInterval(turn, 50);
  });
  const images = () => page.evaluate(() => ({ drawn: spherule.drawn, frames: spherule.session.frames }));
  /** Waits until this number of further images has been drawn. */
  const pass = async (count) => {
    const end = (await images()).drawn + count;
    await when(page, (least) => spherule.drawn >= least, end);
  };
  for (let passed = 0; passed < warm; passed += 100) await pass(100);
  const session = await page.context().newCDPSession(page);
  const all = { includeObjectsCollectedByMajorGC: true, includeObjectsCollectedByMinorGC: true };
  await session.send("HeapProfiler.startSampling", { samplingInterval: 512, ...all });
  const before = await images();
  await pass(200);
  const after = await images();
  const { profile } = await session.send("HeapProfiler.stopSampling");
  const count = Math.max(after.drawn - before.drawn, after.frames - before.frames);
  const each = bytesIn(profile) / count;
  assert.ok(each < 4096, `${each.toFixed(0)} bytes for each of ${count} images`);
  assert.deepEqual(page.faults, []);
  await page.close();
}

test("an image of a moving world, from a moving camera, allocates at most 4 kB", () => expectFrugal());

test("it does not allocate more while the rotation of spheres is shown", async () => {
  await server.ctl("set", "friction", "0.3"); // spheres rotate
  await expectFrugal(async (page) => {
    await showPanel(page, true);
    await page.selectOption(control("rotation"), { label: "Shown" });
    await showPanel(page, false);
    await when(page, () => spherule.session.newest.columns.turn !== undefined);
  });
});
