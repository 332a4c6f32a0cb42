// What others can do to a server through the browser of somebody whom it trusts: nothing. Each test also tries the same where it
// is allowed, so that nothing fails for want of trying.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { control, launch, open, shows, visit, when } from "./support/browser.mjs";
import { tlsOptions } from "./support/certificate.mjs";
import { enter, give, join, says, tokens } from "./support/entrance.mjs";
import { foreignSite, reach } from "./support/foreign.mjs";
import { serve, stopAll } from "./support/server.mjs";

const refused = { stream: "not opened", metrics: "nothing", guess: "nothing", ready: "nothing", blind: "nothing" };

let browser;
let site;
before(async () => {
  browser = await launch();
  site = await foreignSite();
});
after(async () => {
  await browser?.close();
  await site?.close();
  await stopAll();
});

const rejected = (server, cause) => server.metric(`spherule_rejected_total{cause="${cause}"}`);

for (const [words, given] of [
  ["lets everybody on its machine in", undefined],
  ["asks for a token, which the browser has", tokens],
]) {
  test(`a page of another site cannot use a server that ${words}`, async () => {
    const server = await serve("billiards", { tokens: given });
    const context = await browser.newContext();
    const page = given ? await enter(context, server, tokens.controller) : await open(context, server.url);
    const foreign = await context.newPage();
    await foreign.goto(site.url);
    assert.deepEqual(await reach(foreign, server.url), refused);
    assert.equal(await rejected(server, "origin"), 1);
    // In the tab of the page itself, too, which has the token in its store.
    await page.goto(site.url);
    assert.deepEqual(await reach(page, server.url), refused);
    assert.equal(await rejected(server, "origin"), 2);
    assert.equal(await server.metric("spherule_commands_total"), 0);
    await server.stop();

    // Who names another site says also who may come in.
    const options = ["--origin", site.origin, ...(given ? [] : ["--open"])];
    const kind = await serve("billiards", { tokens: given, options });
    assert.deepEqual(await reach(foreign, kind.url), { ...refused, stream: given ? "closed with 4401" : "commanded" });
    assert.equal(await rejected(kind, "origin"), 0);
    await kind.stop();
    await context.close();
  });
}

test("a name of somebody else that leads to the server opens nothing", async () => {
  const misled = await launch("--host-resolver-rules=MAP evil.example 127.0.0.1", "--no-proxy-server");
  try {
    // The page comes from its own server; then its name leads to another one, in the same place.
    const before = await foreignSite();
    const url = `http://evil.example:${before.port}/`;
    const page = await misled.newPage();
    await page.goto(url);
    await before.close();
    const server = await serve("billiards", { port: before.port });
    assert.deepEqual(await reach(page, url), { stream: "not opened", metrics: 421, guess: 421, ready: 421, blind: 421 });
    const times = await rejected(server, "host");
    assert.ok(times >= 5, `${times} of 5`); // after a 421, browsers try another connection
    const answer = await page.goto(url);
    assert.equal(answer.status(), 421);
    assert.match(await answer.text(), /does not go by the name/);
    assert.ok((await rejected(server, "host")) > times);
    assert.equal(await server.metric("spherule_sessions_accepted_total"), 0);
    await server.stop();

    const named = await serve("billiards", { port: before.port, options: ["--open", "--host", "evil.example"] });
    const shown = await open(misled, url);
    assert.deepEqual(await reach(shown, url), { stream: "commanded", metrics: 200, guess: 200, ready: 200, blind: 200 });
    assert.equal(await rejected(named, "host"), 0);
    await named.stop();
  } finally {
    await misled.close();
  }
});

test("another page can neither frame the page nor hold a window of it", async () => {
  const server = await serve("billiards");
  const page = await browser.newPage();
  await page.goto(site.url);
  const framed = async (url) => {
    await page.evaluate(
      (address) =>
        new Promise((resolve) => {
          const frame = document.createElement("iframe");
          frame.onload = resolve;
          frame.src = address;
          document.body.replaceChildren(frame);
        }),
      url,
    );
    return page.frames()[1].evaluate(() => location.href);
  };
  assert.match(await framed(server.url), /^chrome-error:/);
  assert.equal(await framed(`${site.url}other`), `${site.url}other`);

  const held = async (url) => {
    const [popup] = await Promise.all([page.waitForEvent("popup"), page.evaluate((address) => void (window.held = window.open(address)), url)]);
    await popup.waitForURL(url);
    const closed = await page.evaluate(() => window.held.closed);
    await popup.close();
    return !closed;
  };
  assert.equal(await held(server.url), false);
  assert.equal(await held(`${site.url}other`), true);
  await page.close();
  await server.stop();
});

test("the page keeps to its security policy, whatever is done on it", async () => {
  const server = await serve("billiards", { tokens });
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  const violations = [];
  await context.exposeFunction("violated", (what) => violations.push(what));
  await context.addInitScript(() => {
    document.addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI, sourceFile, lineNumber }) =>
      window.violated(`${violatedDirective} ${blockedURI} ${sourceFile}:${lineNumber}`),
    );
  });
  const page = await visit(context, server.url);
  await give(page, "wrong");
  await says(page, "token-wrong", /not known/);
  await give(page, tokens.controller);
  await shows(page);
  for (const key of ["1", "2", "3", "4", "5", "Space", ".", "?", "Escape", "c", "c", "l", "d"]) await page.keyboard.press(key);
  await page.selectOption(control("theme"), "Dark");
  await page.selectOption(control("gravity-preset"), "Moon");
  await page.selectOption(control("auto"), { index: 1 });
  await page.selectOption(control("tier"), { index: 0 });
  await when(page, () => spherule.stream()?.tier === "fine");
  await page.click(control("reset"));
  await when(page, () => spherule.results.some(({ what }) => what === "Reset"));
  await page.selectOption(control("scene"), "bounce");
  await when(page, () => spherule.scene === "bounce");
  const asker = await join(server, "asker");
  await says(page, "control", /asker asks/);
  asker.close();
  await page.mouse.click(500, 400);
  assert.deepEqual(page.faults, []);

  await server.stop();
  await says(page, "connection", /^offline/);
  const again = await serve("billiards", { port: server.port, tokens });
  await when(page, () => spherule.connection === "open" && spherule.scene === "billiards");
  assert.deepEqual(violations, []);

  await page.evaluate(() => document.body.insertAdjacentHTML("beforeend", "<p style='color: red'></p><img src='http://other.example/'>"));
  while (violations.length < 2) await page.waitForTimeout(100);
  assert.match(violations.join("\n"), /^style-src\S* inline/m);
  assert.match(violations.join("\n"), /^img-src http:\/\/other\.example/m);
  await context.close();
  await again.stop();
});

test("over TLS the page loads and streams, for who trusts the certificate", async () => {
  const folder = mkdtempSync(path.join(tmpdir(), "spherule-outsiders-"));
  const trusting = await launch("--ignore-certificate-errors");
  try {
    const server = await serve("billiards", { tokens, options: tlsOptions(folder) });
    assert.match(server.url, /^https:/);
    const page = await enter(trusting, server, tokens.controller);
    await says(page, "connection", /^connected$/);
    const frames = await page.evaluate(() => spherule.frames);
    await when(page, (then) => spherule.frames > then + 3, frames);
    await page.click(control("pause"));
    await when(page, () => spherule.results.at(-1)?.outcome === "applied");
    assert.deepEqual(page.faults, []);
    assert.equal(await page.evaluate(() => isSecureContext && location.protocol), "https:");
    await assert.rejects(visit(browser, server.url), /ERR_CERT_AUTHORITY_INVALID/);
    await server.stop();
  } finally {
    await trusting.close();
    rmSync(folder, { recursive: true });
  }
});
