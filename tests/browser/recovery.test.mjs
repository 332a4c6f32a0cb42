// Faults of the connection, the server and the browser: the page shows them, recovers by itself, and is correct again.
import assert from "node:assert/strict";
import { test } from "node:test";
import { expectPositionsOfServer } from "./support/agreement.mjs";
import { control, launch, open, pause, says, when } from "./support/browser.mjs";
import { proxyTo } from "./support/proxy.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

/** Waits until the header shows this state of the connection. */
const connectionSays = (page, pattern) => says(page, "connection", pattern);

/** Checks that the page is connected, receives moving states, and has the positions of the server. */
async function expectRecovered(page, server) {
  const frames = await page.evaluate(() => spherule.session.frames);
  await when(page, (then) => spherule.session.connection === "open" && spherule.session.frames > then + 3, frames);
  await connectionSays(page, /^connected$/);
  await pause(page);
  await expectPositionsOfServer(page);
  await server.ctl("resume");
  const step = await page.evaluate(() => spherule.session.newest.step);
  await when(page, (then) => !spherule.session.paused && spherule.session.newest?.step > then, step);
}

/** Runs `body` with a page that is connected through a proxy. */
async function behindProxy(body) {
  const server = await serve("pour");
  const proxy = await proxyTo(server.port);
  try {
    const page = await open(suite.browser, proxy.url);
    await expectRecovered(page, server);
    await body(page, proxy, server);
    await page.close();
  } finally {
    proxy.close();
    await server.stop();
  }
}

test("after connection resets, the page continues with the server's present state", async () => {
  await behindProxy(async (page, proxy, server) => {
    for (let round = 0; round < 3; round++) {
      proxy.reset();
      await connectionSays(page, /^offline/);
      await when(page, () => spherule.session.connection === "waiting");
      proxy.restore();
      await expectRecovered(page, server);
    }
  });
});

test("a silent network loss is reported within seconds, and the page recovers", async () => {
  await behindProxy(async (page, proxy, server) => {
    const begun = performance.now();
    proxy.cut();
    await connectionSays(page, /^no answer for \d+ s$/);
    const reported = performance.now() - begun;
    assert.ok(reported < 10_000, `reported after ${reported} ms`);
    assert.equal(await page.evaluate(() => spherule.session.connection), "silent");
    assert.equal(await page.textContent(control("status-stream")), "–");
    // Cut connections never end by themselves, and new ones get no answer.
    await connectionSays(page, /^offline/);
    await connectionSays(page, /^connecting$/);
    await connectionSays(page, /^offline/);
    proxy.restore();
    await expectRecovered(page, server);
  });
});

test("a silence that ends before the page gives up is no longer reported", async () => {
  const server = await serve("pour");
  const page = await open(suite.browser, server.url);
  // A frozen server keeps its connections open.
  server.freeze();
  await connectionSays(page, /^no answer/);
  server.thaw();
  await connectionSays(page, /^connected$/);
  await expectRecovered(page, server);
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
});

test("the page reconnects to a server that was killed and started again", async () => {
  const first = await serve("pour");
  const page = await open(suite.browser, first.url);
  await when(page, () => spherule.session.newest?.simTime > 1);
  await first.kill();
  await connectionSays(page, /^offline/);
  const second = await serve("pour", { port: first.port });
  await expectRecovered(page, second);
  await page.close();
  await second.stop();
});

test("a killed browser's session ends, and another page is not affected", async () => {
  const server = await serve("pour");
  const page = await open(suite.browser, server.url);
  const other = await launch();
  await open(other, server.url);
  assert.equal(await server.metric("spherule_sessions"), 2);
  const left = await server.metric('spherule_sessions_closed_total{cause="left"}');
  await page.evaluate(() => {
    window.states = new Set();
    window.watch = setInterval(() => window.states.add(spherule.session.connection), 20);
  });

  const system = await other.newBrowserCDPSession();
  const { processInfo } = await system.send("SystemInfo.getProcessInfo");
  process.kill(processInfo.find(({ type }) => type === "browser").id, "SIGKILL");
  const gone = Date.now() + 30_000;
  while ((await server.metric("spherule_sessions")) !== 1) {
    assert.ok(Date.now() < gone, "the session of the killed browser is still there");
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  assert.equal(await server.metric('spherule_sessions_closed_total{cause="left"}'), left + 1);

  await expectRecovered(page, server);
  assert.deepEqual(await page.evaluate(() => [...window.states]), ["open"]);
  assert.equal(await page.evaluate(() => spherule.session.lost), 0);
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
});
