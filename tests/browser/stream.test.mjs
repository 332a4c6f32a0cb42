import assert from "node:assert/strict";
import { test } from "node:test";
import { control, open, says, unfold, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
const suite = browserSuite(async () => {
  server = await serve("pour");
});

const fine = "Fine, 1/500 r";
const lostFrames = (page) => page.evaluate(() => spherule.session.lost);

/** Makes the page believe that its tab is hidden or shown. */
async function hide(page, hidden) {
  await page.evaluate((value) => {
    Object.defineProperty(document, "hidden", { get: () => value, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
  }, hidden);
}

test("the server sends the default stream, and the page shows it", async () => {
  const page = await open(suite.browser, server.url, { size: [1280, 900] });
  await says(page, "stream-tier", /^Normal, 1\/50 r$/);
  await says(page, "stream-bytes", /^\S+ B$/);
  const { rate, reduced } = await page.evaluate(() => spherule.session.stream);
  assert.deepEqual([rate, reduced, await lostFrames(page)], [30, false, 0]);
  assert.equal(await page.isVisible(control("stream-note")), false);
  for (const id of ["stream-bytes", "stream-decode"]) {
    assert.ok(parseFloat(await page.textContent(control(id))) > 0, id);
  }
  assert.match(await page.textContent(control("stream-bandwidth")), /^\S+ Mb\/s$/);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("the server sends the chosen precision and rate, and the choice is saved", async () => {
  const page = await open(suite.browser, server.url, { size: [1280, 900] });
  await says(page, "stream-tier", /^Normal/);
  const coarse = await page.evaluate(() => spherule.positions([0]).quantum);
  await unfold(page, "Stream");
  await page.selectOption(control("tier"), { label: fine });
  await says(page, "stream-tier", /^Fine/);
  await when(page, (quantum) => spherule.positions([0])?.quantum < quantum / 9, coarse);
  await page.selectOption(control("rate"), { label: "10" });
  const frames = await page.evaluate(() => spherule.session.frames);
  await when(page, (then) => spherule.session.stream.rate === 10 && spherule.session.frames > then + 5, frames);
  await page.reload();
  await says(page, "stream-tier", /^Fine/);
  await when(page, () => spherule.session.stream.rate === 10 && spherule.session.frames > 2);
  assert.equal(await lostFrames(page), 0);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a hidden page receives no frames, and continues when it is shown", async () => {
  const page = await open(suite.browser, server.url);
  await hide(page, true);
  await when(page, () => spherule.session.stream.rate === 0);
  const before = await page.evaluate(() => ({ frames: spherule.session.frames, step: spherule.session.newest.step }));
  await page.waitForTimeout(1000);
  assert.ok((await page.evaluate(() => spherule.session.frames)) <= before.frames + 1);
  await hide(page, false);
  await when(
    page,
    ({ frames, step }) => spherule.session.frames > frames + 5 && spherule.session.newest.step > step,
    before,
  );
  assert.equal(await lostFrames(page), 0);
  await page.close();
});
