// Attacks by other sites through the browser of a trusted user: none of them works. Each test also repeats the attack
// against a server that allows it, to show that the attack itself is valid.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { chooseScene, control, launch, open, says, shows, unfold, visit, when } from "./support/browser.mjs";
import { tlsOptions } from "./support/certificate.mjs";
import { enter, give, join, tokens } from "./support/entrance.mjs";
import { foreignSite, reach } from "./support/foreign.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const refused = { stream: "not opened", metrics: "nothing", guess: "nothing", ready: "nothing", blind: "nothing" };

let site;
const suite = browserSuite(async () => {
  site = await foreignSite();
});
after(() => site?.close());

const rejected = (server, cause) => server.metric(`spherule_rejected_total{cause="${cause}"}`);

for (const [description, given] of [
  ["admits every local client", undefined],
  ["requires a token that the browser has", tokens],
]) {
  test(`a page of another site cannot use a server that ${description}`, async () => {
    const server = await serve("billiards", { tokens: given });
    const context = await suite.browser.newContext();
    const page = given ? await enter(context, server, tokens.controller) : await open(context, server.url);
    const foreign = await context.newPage();
    await foreign.goto(site.url);
    assert.deepEqual(await reach(foreign, server.url), refused);
    assert.equal(await rejected(server, "origin"), 1);
    // The same in the tab of the page itself, whose storage has the token.
    await page.goto(site.url);
    assert.deepEqual(await reach(page, server.url), refused);
    assert.equal(await rejected(server, "origin"), 2);
    assert.equal(await server.metric("spherule_commands_total"), 0);
    await server.stop();

    // An allowed origin needs tokens, or --open.
    const options = ["--origin", site.origin, ...(given ? [] : ["--open"])];
    const permissive = await serve("billiards", { tokens: given, options });
    const stream = given ? "closed with 4401" : "commanded";
    assert.deepEqual(await reach(foreign, permissive.url), { ...refused, stream });
    assert.equal(await rejected(permissive, "origin"), 0);
    await permissive.stop();
    await context.close();
  });
}

test("a foreign host name that resolves to the server gives no access", async () => {
  const misled = await launch("--host-resolver-rules=MAP evil.example 127.0.0.1", "--no-proxy-server");
  try {
    // The page comes from its own server. Then its host name resolves to our server, on the same port.
    const before = await foreignSite();
    const url = `http://evil.example:${before.port}/`;
    const page = await misled.newPage();
    await page.goto(url);
    await before.close();
    const server = await serve("billiards", { port: before.port });
    const misdirected = { metrics: 421, guess: 421, ready: 421, blind: 421 };
    assert.deepEqual(await reach(page, url), { stream: "not opened", ...misdirected });
    const times = await rejected(server, "host");
    assert.ok(times >= 5, `${times} of 5`); // browsers retry on another connection after a 421
    const answer = await page.goto(url);
    assert.equal(answer.status(), 421);
    assert.match(await answer.text(), /does not go by the name/);
    assert.ok((await rejected(server, "host")) > times);
    assert.equal(await server.metric("spherule_sessions_accepted_total"), 0);
    await server.stop();

    const named = await serve("billiards", { port: before.port, options: ["--open", "--host", "evil.example"] });
    const shown = await open(misled, url);
    const served = { metrics: 200, guess: 200, ready: 200, blind: 200 };
    assert.deepEqual(await reach(shown, url), { stream: "commanded", ...served });
    assert.equal(await rejected(named, "host"), 0);
    await named.stop();
  } finally {
    await misled.close();
  }
});

test("a foreign page can neither embed the page nor keep a handle to its window", async () => {
  const server = await serve("billiards");
  const page = await suite.browser.newPage();
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
    const popupOpens = page.waitForEvent("popup");
    await page.evaluate((address) => void (window.held = window.open(address)), url);
    const popup = await popupOpens;
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

test("no action on the page violates its security policy", async () => {
  const server = await serve("billiards", { tokens });
  const context = await suite.browser.newContext({ viewport: { width: 1280, height: 900 } });
  const violations = [];
  await context.exposeFunction("violated", (violation) => violations.push(violation));
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
  for (const key of ["1", "2", "3", "4", "5", "Space", ".", "?", "Escape", "c", "c", "l", "d"]) {
    await page.keyboard.press(key);
  }
  await page.selectOption(control("theme"), "Dark");
  await page.selectOption(control("gravity-preset"), "Moon");
  await page.selectOption(control("auto"), { index: 1 });
  await unfold(page, "Stream");
  await page.selectOption(control("tier"), { index: 0 });
  await says(page, "stream-tier", /^Fine/);
  await page.click(control("reset"));
  await when(page, () => spherule.reports.some(({ name }) => name === "Reset"));
  await chooseScene(page, "bounce");
  await when(page, () => spherule.session.facts?.name === "bounce");
  const asker = await join(server, "asker");
  await says(page, "control", /asker requests/);
  asker.close();
  await page.mouse.click(500, 400);
  assert.deepEqual(page.faults, []);

  await server.stop();
  await says(page, "connection", /^offline/);
  const again = await serve("billiards", { port: server.port, tokens });
  await when(page, () => spherule.session.connection === "open" && spherule.session.facts.name === "billiards");
  assert.deepEqual(violations, []);

  const forbidden = "<p style='color: red'></p><img src='http://other.example/'>";
  await page.evaluate((html) => document.body.insertAdjacentHTML("beforeend", html), forbidden);
  while (violations.length < 2) await page.waitForTimeout(100);
  assert.match(violations.join("\n"), /^style-src\S* inline/m);
  assert.match(violations.join("\n"), /^img-src http:\/\/other\.example/m);
  await context.close();
  await again.stop();
});

test("over TLS the page loads and streams if the browser trusts the certificate", async () => {
  const trusting = await launch("--ignore-certificate-errors");
  try {
    const server = await serve("billiards", { tokens, options: tlsOptions(suite.folder) });
    assert.match(server.url, /^https:/);
    const page = await enter(trusting, server, tokens.controller);
    await says(page, "connection", /^connected$/);
    const frames = await page.evaluate(() => spherule.session.frames);
    await when(page, (then) => spherule.session.frames > then + 3, frames);
    await page.click(control("pause"));
    await when(page, () => spherule.reports.at(-1)?.outcome.case === "applied");
    assert.deepEqual(page.faults, []);
    assert.equal(await page.evaluate(() => isSecureContext && location.protocol), "https:");
    await assert.rejects(visit(suite.browser, server.url), /ERR_CERT_AUTHORITY_INVALID/);
    await server.stop();
  } finally {
    await trusting.close();
  }
});
