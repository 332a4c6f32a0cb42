// The server ends: the page says why for as long as nothing comes, and goes on by itself with the next one.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { control, launch, open, when } from "./support/browser.mjs";
import { collisions } from "./support/layout.mjs";
import { serve, stopAll } from "./support/server.mjs";

let browser;
let folder;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(path.join(tmpdir(), "spherule-failure-"));
});
after(async () => {
  await browser?.close();
  await stopAll();
  rmSync(folder, { recursive: true });
});

/** Mesa's renderer until `strike` is called: then the device is lost. See tests/faults/faulty_driver.c. */
function faultyDriver() {
  const vendor = path.join(folder, "faulty.json");
  const library = path.resolve(process.env.FAULTY_DRIVER ?? "build/release/tests/faults/libfaulty_driver.so");
  writeFileSync(vendor, JSON.stringify({ file_format_version: "1.0.0", ICD: { library_path: library } }));
  const when = path.join(folder, "strike");
  return {
    settings: { __EGL_VENDOR_LIBRARY_FILENAMES: vendor, SPHERULE_FAULT: "reset", SPHERULE_FAULT_WHEN: when },
    strike: () => writeFileSync(when, ""),
  };
}

const farewell = (page) => page.textContent(control("farewell"));

/** The page says why it hears nothing, until the next server answers; and nothing lies over it. */
async function expectSaid(page, port, pattern) {
  await when(page, () => /^offline, trying again in \d+ s$/.test(document.querySelector('[data-testid="connection"]').textContent));
  assert.match(await farewell(page), pattern);
  await settledToasts(page);
  assert.deepEqual(await collisions(page, 10), []);
  assert.match(await farewell(page), pattern);
  if (process.env.SCREENSHOTS) await page.screenshot({ path: path.join(process.env.SCREENSHOTS, `farewell-${port}.png`) });
  const frames = await page.evaluate(() => spherule.frames);
  const next = await serve("pour", { port });
  await when(page, (then) => spherule.connection === "open" && spherule.frames > then + 3, frames);
  // What stands in the header is renewed five times a second.
  await when(page, () => document.querySelector('[data-testid="farewell"]').textContent === "");
  await next.stop();
}

/** Messages of before are gone. */
async function settledToasts(page) {
  await when(page, () => document.querySelector('[data-testid="toast"]') === null);
}

test("a device that is lost is told, and the page goes on with the server that is started again", async () => {
  const driver = faultyDriver();
  const server = await serve("two-spheres", { device: "software", settings: driver.settings });
  const page = await open(browser, server.url, { size: [360, 640] });
  driver.strike();
  assert.equal(await server.ended(), 75);
  await expectSaid(page, server.port, /The simulation has ended \(llvmpipe.*was reset.*\): this page goes on by itself/);
  await page.close();
});

test("a server that is stopped says so", async () => {
  const server = await serve("two-spheres");
  const page = await open(browser, server.url);
  await server.stop();
  await expectSaid(page, server.port, /The server is stopping\./);
  await page.close();
});
