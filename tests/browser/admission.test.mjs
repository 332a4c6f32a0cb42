// Tokens, roles and control of the simulation.
import assert from "node:assert/strict";
import path from "node:path";
import { test } from "node:test";
import { control, open, says, shows, unfold, visit, when } from "./support/browser.mjs";
import { enter, give, join, prompt, tokens } from "./support/entrance.mjs";
import { collisionsByWidth } from "./support/layout.mjs";
import { proxyTo } from "./support/proxy.mjs";
import { play, serve, spherule } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server; // requires tokens
const suite = browserSuite(async () => {
  server = await serve("billiards", { tokens });
});

const text = (page, id) => page.textContent(control(id));
const toasts = (page) => page.locator(control("toast")).allTextContents();

/** Waits until the page shows this state of control. */
async function controlIs(page, state) {
  await page.waitForSelector(`${control("control")}[data-state="${state}"]`, { state: "attached" });
}

/** Stops the server, and starts it again on the same port with these tokens. */
async function restart(page, server, tokens) {
  await server.stop();
  await when(page, () => spherule.session.connection === "waiting");
  return serve("billiards", { port: server.port, tokens });
}

/** Returns the places in the page, its address and its storage in which the text occurs. */
function traces(page, text) {
  return page.evaluate((wanted) => {
    const fields = [...document.querySelectorAll("input")].map((input) => input.value).join(" ");
    const stores = { local: JSON.stringify(localStorage), session: JSON.stringify(sessionStorage) };
    const places = { document: document.documentElement.outerHTML, fields, address: location.href, ...stores };
    return Object.keys(places).filter((place) => places[place].includes(wanted));
  }, text);
}

test("a page of a server without tokens never mentions tokens", async () => {
  const openServer = await serve("billiards");
  const page = await open(suite.browser, openServer.url);
  for (const id of ["token-prompt", "role", "control", "forget-token", "notice"]) {
    assert.equal(await page.isVisible(control(id)), false, id);
  }
  await controlIs(page, "unrestricted");
  await page.click(control("pause"));
  await when(page, () => spherule.reports.at(-1)?.outcome.case === "applied");
  assert.deepEqual(page.faults, []);
  await page.close();
  await openServer.stop();
});

test("the page asks for a token, reports a wrong one, and connects with a valid one", async () => {
  let own = await serve("billiards", { tokens });
  const page = await visit(suite.browser, own.url);
  await page.waitForSelector(prompt);
  assert.match(await text(page, "token-prompt"), new RegExp(new URL(own.url).host));
  await says(page, "connection", /^token required$/);
  assert.equal(await text(page, "token-wrong"), "");
  assert.equal(await page.evaluate(() => document.activeElement.dataset.testid), "token-field");
  assert.equal(await page.getAttribute(control("token-field"), "type"), "password");

  await page.keyboard.type("a guess");
  await page.click(control("token-reveal"));
  assert.equal(await page.getAttribute(control("token-field"), "type"), "text");
  await page.click(control("token-connect"));
  await says(page, "token-wrong", /^This token is not known here\.$/);
  assert.equal(await page.getAttribute(control("token-field"), "type"), "password");
  assert.equal(await page.evaluate(() => document.activeElement.dataset.testid), "token-field");
  assert.deepEqual(await traces(page, "a guess"), []);
  await page.waitForTimeout(1500);
  assert.equal(await page.evaluate(() => spherule.session.connection), "locked", "the page waits for another token");

  await give(page, ` ${tokens.controller}\t`);
  await shows(page);
  await page.waitForSelector(prompt, { state: "hidden" });
  await says(page, "connection", /^connected$/);
  assert.deepEqual(await traces(page, tokens.controller), ["session"]);

  for (let round = 0; round < 2; round++) {
    own = await restart(page, own, tokens);
    const frames = await page.evaluate(() => spherule.session.frames);
    await when(page, (then) => spherule.session.connection === "open" && spherule.session.frames > then, frames);
  }
  await page.reload();
  await shows(page);
  assert.equal(await page.isVisible(prompt), false);
  assert.equal(await own.metric('spherule_rejected_total{cause="no_token"}'), 0);
  await page.close();
  await own.stop();
});

test("a closed token dialog opens again from the header", async () => {
  const page = await visit(suite.browser, server.url);
  await page.waitForSelector(prompt);
  await page.keyboard.type("half");
  await page.keyboard.press("Escape");
  await page.waitForSelector(prompt, { state: "hidden" });
  await page.click(control("retry"));
  await page.waitForSelector(prompt);
  assert.equal(await page.inputValue(control("token-field")), "");
  await page.keyboard.press("Enter");
  await says(page, "token-wrong", /no token/);
  await give(page, tokens.viewer);
  await shows(page);
  await page.close();
});

test("a remembered token is forgotten when it is rejected, and on request", async () => {
  const another = "another-token-of-a-test";
  const first = await serve("billiards", { tokens });
  const page = await enter(suite.browser, first, tokens.controller);
  const second = await restart(page, first, { ...tokens, controller: another });
  await page.waitForSelector(prompt);
  assert.equal(await text(page, "token-wrong"), "This token is not known here.");
  assert.deepEqual(await traces(page, tokens.controller), []);
  await give(page, another);
  await says(page, "connection", /^connected$/);

  await page.click(control("forget-token"));
  await page.waitForSelector(prompt);
  assert.equal(await text(page, "token-wrong"), "");
  assert.deepEqual(await traces(page, another), []);
  await page.reload();
  await page.waitForSelector(prompt);
  await page.close();
  await second.stop();
});

test("a token in the address is removed, reported, and not used", async () => {
  const page = await visit(suite.browser, `${server.url}?token=${tokens.controller}&theme=dark`);
  await page.waitForSelector(prompt);
  assert.deepEqual(await traces(page, tokens.controller), []);
  assert.match(page.url(), /theme=dark/);
  assert.match((await toasts(page)).join(), /Do not put tokens in addresses/);
  assert.match(await text(page, "token-wrong"), /in the address was ignored/);
  await page.close();
});

test("for a viewer, controls that send commands are disabled with a reason, and others work", async () => {
  const commands = await server.metric("spherule_commands_total");
  const page = await enter(suite.browser, server, tokens.viewer, { size: [1280, 900] });
  await says(page, "role", /^watching$/);
  assert.equal(await page.isVisible(control("role")), true);
  assert.equal(await page.isVisible(control("control")), false);
  const buttons = ["pause", "step", "step-count", "step-many", "reset", "record"];
  for (const id of [...buttons, "dial", "gravity-preset", "restitution", "drop", "tool"]) {
    assert.equal(await page.isDisabled(control(id)), true, id);
    const title = await page.locator(control(id)).evaluate((element) => element.closest("[title]").title);
    assert.match(title, /watch but not control/, id);
  }
  for (const key of ["Space", ".", "r", "d", "p", "Space"]) await page.keyboard.press(key);
  assert.deepEqual(await toasts(page), ["Not sentYou can watch but not control"]);

  for (const id of ["scenes", "colour", "theme", "tier", "home", "legend-lock"]) {
    assert.equal(await page.isDisabled(control(id)), false, id);
  }
  await unfold(page, "Stream");
  await page.selectOption(control("tier"), { index: 0 });
  await says(page, "stream-tier", /^Fine/);
  const eye = await page.evaluate(() => spherule.camera.eye);
  await page.keyboard.press("ArrowLeft");
  await when(page, (then) => spherule.camera.eye[0] !== then[0], eye);
  assert.equal(await server.metric("spherule_commands_total"), commands);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a viewer of a recording cannot seek", async () => {
  const file = path.join(suite.folder, "short.spr");
  await spherule("run", "billiards", "--for", "1", "--device", "cpu", "--record", file);
  const player = await play(file, { tokens });
  const page = await enter(suite.browser, player, tokens.viewer);
  await page.waitForSelector(control("timeline"));
  assert.equal(await page.isDisabled(control("timeline")), true);
  assert.match(await page.getAttribute(control("timeline"), "title"), /not control/);
  assert.equal(await page.isDisabled(control("speed")), true);
  await page.close();
  await player.stop();
});

test("control is requested, kept, withdrawn, handed over and released", async () => {
  const one = await enter(suite.browser, server, tokens.controller);
  const two = await enter(suite.browser, server, tokens.controller);
  const number = (page) => page.evaluate(() => Number(spherule.session.welcome.session));
  const [first, second] = [await number(one), await number(two)];
  assert.equal(await one.isVisible(control("control")), false, "no client has control: nothing is shown");

  await one.click(control("pause"));
  await controlIs(one, "mine");
  await says(one, "control", /^You have control\s*Release$/);
  await says(two, "control", new RegExp(`^spherule viewer\\s*#${first} has control`));
  assert.equal(await two.isDisabled(control("pause")), true);
  await two.keyboard.press("Space");
  await two.keyboard.press("r");
  const unsent = (await toasts(two)).filter((text) => text.startsWith("Not sent"));
  assert.deepEqual(unsent, [`Not sentspherule viewer #${first} has control`]);

  await two.click(control("control-ask"));
  await says(two, "control", /^Requested; waiting for/);
  await says(one, "control", new RegExp(`#${second} requests`));
  await two.click(control("control-withdraw"));
  await says(one, "control", /^You have control\s*Release$/);
  await two.waitForSelector(control("control-ask"));
  assert.equal(
    (await toasts(two)).some((text) => /keeps/.test(text)),
    false,
    "a withdrawn request gets no answer",
  );

  await two.click(control("control-ask"));
  await one.click(control("control-keep"));
  await two.waitForSelector(control("control-ask"));
  await says(two, "toasts", new RegExp(`#${first} keeps control`));

  await two.click(control("control-ask"));
  await one.click(control("control-hand-over"));
  await controlIs(two, "mine");
  await controlIs(one, "taken");
  await says(two, "toasts", /You have control/);
  assert.equal(await two.isDisabled(control("pause")), false);
  assert.equal(await one.isDisabled(control("pause")), true);
  await two.click(control("pause"));
  await when(two, () => spherule.reports.at(-1)?.outcome.case === "applied");

  await two.click(control("control-release"));
  await controlIs(one, "free");
  await controlIs(two, "free");
  await one.click(control("reset"));
  await controlIs(one, "mine");
  await one.close();
  await controlIs(two, "free");
  assert.deepEqual([...one.faults, ...two.faults], []);
  await two.close();
});

test("names are shown as text, duplicates get numbers, and many requests cover no element", async () => {
  const page = await enter(suite.browser, server, tokens.controller, { size: [1280, 800] });
  await page.click(control("pause"));
  await controlIs(page, "mine");
  const others = [];
  const names = ["<img src=x onerror=alert(1)>", "twin", "twin", `long ${"name ".repeat(40)}`, "\u202efifth"];
  for (const name of names) others.push(await join(server, name));
  await says(page, "control", /and 2 more/);
  assert.match(await text(page, "control"), /<img src=x onerror=alert\(1\)> requests/);
  assert.equal(await page.locator(".steering img").count(), 0);
  const numbers = await page.locator(".steering i").allTextContents();
  assert.equal(new Set(numbers).size, 2);
  assert.equal(await page.locator(control("control-hand-over")).count(), 3);
  for (const { width, faults } of await collisionsByWidth(page, 5)) assert.deepEqual(faults, [], `${width} px`);
  for (const other of others) other.close();
  await says(page, "control", /^You have control\s*Release$/);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("the page retries while the server is full", async () => {
  const small = await serve("billiards", { tokens, options: ["--max-sessions", "1"] });
  const first = await enter(suite.browser, small, tokens.viewer);
  const page = await visit(suite.browser, small.url);
  await give(page, tokens.viewer);
  await says(page, "notice-text", /^It says: The limit of open sessions is reached\./);
  await says(page, "connection", /^offline, trying again in \d+ s$/);
  assert.ok((await small.metric('spherule_rejected_total{cause="sessions"}')) > 0);
  await first.close();
  await shows(page);
  await says(page, "connection", /^connected$/);
  await page.close();
  await small.stop();
});

test("the page shows the reason of a refusal, and retries", async () => {
  const proxy = await proxyTo(server.port);
  try {
    const page = await enter(suite.browser, proxy, tokens.viewer);
    proxy.stutter(true);
    proxy.reset();
    proxy.restore();
    await says(page, "notice-text", /^It says: Hello was sent before\./);
    await says(page, "connection", /^offline, trying again/);
    proxy.stutter(false);
    await page.waitForSelector(control("notice"), { state: "detached" });
    await says(page, "connection", /^connected$/);
    await page.close();
  } finally {
    proxy.close();
  }
});
