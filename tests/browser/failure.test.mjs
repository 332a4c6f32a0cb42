// When the server ends, the page shows the reason until it has reconnected to the next server by itself.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { control, open, says, when } from "./support/browser.mjs";
import { collisions } from "./support/layout.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

/**
 * A driver that passes all calls to Mesa until `strike` is called: then the device is lost. See
 * tests/faults/faulty_driver.c.
 */
function faultyDriver() {
  const vendor = path.join(suite.folder, "faulty.json");
  const library = path.resolve(process.env.FAULTY_DRIVER ?? "build/release/tests/faults/libfaulty_driver.so");
  writeFileSync(vendor, JSON.stringify({ file_format_version: "1.0.0", ICD: { library_path: library } }));
  const when = path.join(suite.folder, "strike");
  return {
    settings: { __EGL_VENDOR_LIBRARY_FILENAMES: vendor, SPHERULE_FAULT: "reset", SPHERULE_FAULT_WHEN: when },
    strike: () => writeFileSync(when, ""),
  };
}

const farewell = (page) => page.textContent(control("notice-text"));

/** Checks that the page shows the reason until the next server answers, and that no element covers it. */
async function expectFarewell(page, port, pattern) {
  await says(page, "connection", /^offline, trying again in \d+ s$/);
  assert.match(await farewell(page), pattern);
  await when(page, () => document.querySelector('[data-testid="toast"]') === null);
  assert.deepEqual(await collisions(page, 10), []);
  assert.match(await farewell(page), pattern);
  const { SCREENSHOTS } = process.env;
  if (SCREENSHOTS) await page.screenshot({ path: path.join(SCREENSHOTS, `farewell-${port}.png`) });
  const frames = await page.evaluate(() => spherule.session.frames);
  const next = await serve("pour", { port });
  await when(page, (then) => spherule.session.connection === "open" && spherule.session.frames > then + 3, frames);
  await when(page, () => !/It says/.test(document.querySelector('[data-testid="notices"]').textContent));
  await next.stop();
}

test("after the loss of the device, the page shows the reason and reconnects to the next server", async () => {
  const driver = faultyDriver();
  const server = await serve("two-spheres", { device: "software", settings: driver.settings });
  const page = await open(suite.browser, server.url, { size: [360, 640] });
  driver.strike();
  assert.equal(await server.ended(), 75);
  const reason = /It says: The simulation has ended \(llvmpipe.*was reset.*\): this page goes on by itself/;
  await expectFarewell(page, server.port, reason);
  await page.close();
});

test("the page shows that the server was stopped", async () => {
  const server = await serve("two-spheres");
  const page = await open(suite.browser, server.url);
  await server.stop();
  await expectFarewell(page, server.port, /The server is stopping\./);
  await page.close();
});
