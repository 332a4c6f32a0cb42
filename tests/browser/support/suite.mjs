// The browser and the folder that the tests of a file share.
import { mkdtempSync, rmSync } from "node:fs";
import { after, before } from "node:test";
import { tmpdir } from "node:os";
import path from "node:path";
import { launch } from "./browser.mjs";
import { stopAll } from "./server.mjs";

/**
 * Starts a browser and creates a folder before the tests of a file. Afterwards closes the browser, stops all servers
 * and removes the folder. `setUp` runs in between, and is given both. Returns an object that has them as `browser` and
 * `folder` while the tests run.
 */
export function browserSuite(setUp = () => {}) {
  const suite = { browser: undefined, folder: undefined };
  before(async () => {
    suite.folder = mkdtempSync(path.join(tmpdir(), "spherule-test-"));
    suite.browser = await launch();
    await setUp(suite.browser, suite.folder);
  });
  after(async () => {
    await suite.browser?.close();
    await stopAll();
    if (suite.folder) rmSync(suite.folder, { recursive: true, force: true });
  });
  return suite;
}
