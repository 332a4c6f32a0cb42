// What goes wrong between page and server, or with either: the page says so, comes back by itself, and is right again.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { expectPositionsOfServer } from "./support/agreement.mjs";
import { control, launch, open, pause, when } from "./support/browser.mjs";
import { proxyTo } from "./support/proxy.mjs";
import { serve, stopAll } from "./support/server.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await stopAll();
});

/** What the page says of its connection becomes this. */
async function says(page, pattern) {
  await when(page, (source) => new RegExp(source).test(document.querySelector('[data-testid="connection"]').textContent), pattern.source);
}

/** The page is connected, is sent moving states, and has the positions that the server has. */
async function expectRight(page, server) {
  const frames = await page.evaluate(() => spherule.frames);
  await when(page, (then) => spherule.connection === "open" && spherule.frames > then + 3, frames);
  await says(page, /^connected$/);
  await pause(page);
  await expectPositionsOfServer(page);
  await server.ctl("resume");
  await when(page, (step) => !spherule.paused && spherule.step > step, await page.evaluate(() => spherule.step));
}

/** A page that hears of the server through a proxy. */
async function behindProxy(body) {
  const server = await serve("pour");
  const proxy = await proxyTo(server.port);
  try {
    const page = await open(browser, proxy.url);
    await expectRight(page, server);
    await body(page, proxy, server);
    await page.close();
  } finally {
    proxy.close();
    await server.stop();
  }
}

test("after resets of its connection the page goes on where the server is", async () => {
  await behindProxy(async (page, proxy, server) => {
    for (let round = 0; round < 3; round++) {
      proxy.reset();
      await says(page, /^offline/);
      await when(page, () => spherule.connection === "waiting");
      proxy.restore();
      await expectRight(page, server);
    }
  });
});

test("a network that vanishes silently is noticed within seconds, and the page comes back with it", async () => {
  await behindProxy(async (page, proxy, server) => {
    const begun = performance.now();
    proxy.cut();
    await says(page, /^no answer for \d+ s$/);
    const told = performance.now() - begun;
    assert.ok(told < 10_000, `told after ${told} ms`);
    assert.equal(await page.evaluate(() => spherule.connection), "silent");
    assert.equal(await page.textContent(control("status-stream")), "–");
    // Connections that were cut never end by themselves; new ones get no answer.
    await says(page, /^offline/);
    await says(page, /^connecting$/);
    await says(page, /^offline/);
    proxy.restore();
    await expectRight(page, server);
  });
});

test("a cut that ends before the page gives up is told as over", async () => {
  const server = await serve("pour");
  const page = await open(browser, server.url);
  // The server stands still as its machine might: connections stay as they are.
  server.freeze();
  await says(page, /^no answer/);
  server.thaw();
  await says(page, /^connected$/);
  await expectRight(page, server);
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
});

test("a killed server that is started again is found, and its world shown", async () => {
  const first = await serve("pour");
  const page = await open(browser, first.url);
  await when(page, () => spherule.simTime > 1);
  await first.kill();
  await says(page, /^offline/);
  const second = await serve("pour", { port: first.port });
  await expectRight(page, second);
  await page.close();
  await second.stop();
});

test("a killed browser is forgotten, and another page goes on undisturbed", async () => {
  const server = await serve("pour");
  const page = await open(browser, server.url);
  const other = await launch();
  await open(other, server.url);
  assert.equal(await server.metric("spherule_sessions"), 2);
  const left = await server.metric('spherule_sessions_closed_total{cause="left"}');
  await page.evaluate(() => {
    window.states = new Set();
    window.watch = setInterval(() => window.states.add(spherule.connection), 20);
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

  await expectRight(page, server);
  assert.deepEqual(await page.evaluate(() => [...window.states]), ["open"]);
  assert.equal(await page.evaluate(() => spherule.stream().lost), 0);
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
});
