// The browser that the tests of a file share.
import { after, before } from "node:test";
import { launch } from "./browser.mjs";
import { stopAll } from "./server.mjs";

/**
 * Starts a browser before the tests of a file; afterwards closes it and stops all servers. `setUp` runs in between, and
 * is given the browser. Returns an object that has the browser as `browser` while the tests run.
 */
export function browserSuite(setUp = () => {}) {
  const suite = { browser: undefined };
  before(async () => {
    suite.browser = await launch();
    await setUp(suite.browser);
  });
  after(async () => {
    await suite.browser?.close();
    await stopAll();
  });
  return suite;
}
