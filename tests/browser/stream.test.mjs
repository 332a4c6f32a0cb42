import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { control, launch, open, when } from "./support/browser.mjs";
import { serve, stopAll } from "./support/server.mjs";

let server;
let browser;
before(async () => {
  server = await serve("pour");
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await stopAll();
});

const sent = (page) => page.evaluate(() => spherule.stream());

/** Makes the page believe that its tab is hidden, or shown again. */
async function hide(page, hidden) {
  await page.evaluate((value) => {
    Object.defineProperty(document, "hidden", { get: () => value, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
  }, hidden);
}

test("the page is sent what it usually asks for, and says so", async () => {
  const page = await open(browser, server.url, { size: [1280, 900] });
  await when(page, () => spherule.stream()?.bytesPerSphere > 0);
  const { tier, rate, reduced, decodeMs, lost } = await sent(page);
  assert.deepEqual([tier, rate, reduced, lost], ["normal", 30, false, 0]);
  assert.ok(decodeMs > 0);
  await when(page, () => document.querySelector('[data-testid="stream-tier"]')?.textContent === "Normal, 1/50 r");
  assert.match(await page.textContent(control("stream-bandwidth")), /^\S+ Mb\/s$/);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("another error and rate are sent when they are chosen, and the wish is kept", async () => {
  const page = await open(browser, server.url, { size: [1280, 900] });
  await when(page, () => spherule.stream()?.tier === "normal");
  const coarse = await page.evaluate(() => spherule.positions([0]).quantum);
  await page.selectOption(control("tier"), { label: "Fine, 1/500 r" });
  await when(page, (quantum) => spherule.stream().tier === "fine" && spherule.positions([0])?.quantum < quantum / 9, coarse);
  await page.selectOption(control("rate"), { label: "10" });
  const frames = await page.evaluate(() => spherule.frames);
  await when(page, (then) => spherule.stream().rate === 10 && spherule.frames > then + 5, frames);
  await page.reload();
  await when(page, () => window.spherule?.stream()?.tier === "fine" && spherule.stream().rate === 10 && spherule.frames > 2);
  assert.equal((await sent(page)).lost, 0);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a hidden page is sent nothing, and goes on when it is shown", async () => {
  const page = await open(browser, server.url);
  await hide(page, true);
  await when(page, () => spherule.stream().rate === 0);
  const { frames, step } = await page.evaluate(() => ({ frames: spherule.frames, step: spherule.step }));
  await page.waitForTimeout(1000);
  assert.ok((await page.evaluate(() => spherule.frames)) <= frames + 1);
  await hide(page, false);
  await when(page, (then) => spherule.frames > then.frames + 5 && spherule.step > then.step, { frames, step });
  assert.equal((await sent(page)).lost, 0);
  await page.close();
});
