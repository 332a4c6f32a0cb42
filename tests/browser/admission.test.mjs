// Who is let in, and who may steer.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { control, launch, open, shows, visit, when } from "./support/browser.mjs";
import { enter, give, join, prompt, says, tokens } from "./support/entrance.mjs";
import { collisionsByWidth } from "./support/layout.mjs";
import { proxyTo } from "./support/proxy.mjs";
import { play, serve, spherule, stopAll } from "./support/server.mjs";

let server; // that asks for tokens
let browser;
before(async () => {
  server = await serve("billiards", { tokens });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await stopAll();
});

const text = (page, id) => page.textContent(control(id));
const stands = (page, kind) => when(page, (wanted) => spherule.standing === wanted, kind);
const toasts = (page) => page.locator(control("toast")).allTextContents();

/** Stops the server and starts it with these tokens in the same place; returns it. */
async function startAnew(page, server, tokens) {
  await server.stop();
  await when(page, () => spherule.connection === "waiting");
  return serve("billiards", { port: server.port, tokens });
}

/** Where in the page, its address or its stores the words are found. */
function traces(page, words) {
  return page.evaluate((wanted) => {
    const fields = [...document.querySelectorAll("input")].map((input) => input.value).join(" ");
    const stores = { local: JSON.stringify(localStorage), session: JSON.stringify(sessionStorage) };
    const places = { document: document.documentElement.outerHTML, fields, address: location.href, ...stores };
    return Object.keys(places).filter((place) => places[place].includes(wanted));
  }, words);
}

test("a server that asks for no token is never asked about one", async () => {
  const everybodys = await serve("billiards");
  const page = await open(browser, everybodys.url);
  for (const id of ["token-prompt", "role", "control", "forget-token", "refusal"]) assert.equal(await page.isVisible(control(id)), false, id);
  assert.equal(await page.evaluate(() => spherule.standing), "everybody");
  await page.click(control("pause"));
  await when(page, () => spherule.results.at(-1)?.outcome === "applied");
  assert.deepEqual(page.faults, []);
  await page.close();
  await everybodys.stop();
});

test("a token is asked for, a wrong one is said to be wrong, the right one opens", async () => {
  let own = await serve("billiards", { tokens });
  const page = await visit(browser, own.url);
  await page.waitForSelector(prompt);
  assert.match(await text(page, "token-prompt"), new RegExp(new URL(own.url).host));
  await says(page, "connection", /^a token is needed$/);
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
  assert.equal(await page.evaluate(() => spherule.connection), "locked", "it waits for another token");

  await give(page, ` ${tokens.controller}\t`);
  await shows(page);
  await page.waitForSelector(prompt, { state: "hidden" });
  await says(page, "connection", /^connected$/);
  assert.deepEqual(await traces(page, tokens.controller), ["session"]);

  for (let round = 0; round < 2; round++) {
    own = await startAnew(page, own, tokens);
    const frames = await page.evaluate(() => spherule.frames);
    await when(page, (then) => spherule.connection === "open" && spherule.frames > then, frames);
  }
  await page.reload();
  await shows(page);
  assert.equal(await page.isVisible(prompt), false);
  assert.equal(await own.metric('spherule_rejected_total{cause="no_token"}'), 0);
  await page.close();
  await own.stop();
});

test("a dialog that was closed is opened again from the header", async () => {
  const page = await visit(browser, server.url);
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

test("a remembered token that is refused is forgotten, and so is one that shall be", async () => {
  const another = "another-token-of-a-test";
  const first = await serve("billiards", { tokens });
  const page = await enter(browser, first, tokens.controller);
  const second = await startAnew(page, first, { ...tokens, controller: another });
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

test("a token in the address is taken out, told, and not used", async () => {
  const page = await visit(browser, `${server.url}?token=${tokens.controller}&theme=dark`);
  await page.waitForSelector(prompt);
  assert.deepEqual(await traces(page, tokens.controller), []);
  assert.match(page.url(), /theme=dark/);
  assert.match((await toasts(page)).join(), /Tokens do not belong in addresses/);
  assert.match(await text(page, "token-wrong"), /in the address was not used/);
  await page.close();
});

test("a viewer watches: what commands is out of use and says why, the rest works", async () => {
  const commands = await server.metric("spherule_commands_total");
  const page = await enter(browser, server, tokens.viewer, { size: [1280, 900] });
  await says(page, "role", /^watching$/);
  assert.equal(await page.isVisible(control("role")), true);
  assert.equal(await page.isVisible(control("control")), false);
  for (const id of ["pause", "step", "step-count", "step-many", "reset", "record", "scene", "dial", "gravity-preset", "restitution", "drop", "push"]) {
    assert.equal(await page.isDisabled(control(id)), true, id);
    const why = await page.evaluate((name) => document.querySelector(`[data-testid="${name}"]`).closest("[title]").title, id);
    assert.match(why, /watch here, not steer/, id);
  }
  for (const key of ["Space", ".", "r", "d", "p", "Space"]) await page.keyboard.press(key);
  assert.deepEqual(await toasts(page), ["Not doneYou may watch here, not steer"]);

  for (const id of ["colour", "theme", "tier", "home", "legend-lock"]) assert.equal(await page.isDisabled(control(id)), false, id);
  await page.selectOption(control("tier"), { index: 0 });
  await when(page, () => spherule.stream()?.tier === "fine");
  const eye = await page.evaluate(() => spherule.camera.eye);
  await page.keyboard.press("ArrowLeft");
  await when(page, (then) => spherule.camera.eye[0] !== then[0], eye);
  assert.equal(await server.metric("spherule_commands_total"), commands);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a viewer of a recording cannot move its handle", async () => {
  const folder = mkdtempSync(path.join(tmpdir(), "spherule-admission-"));
  try {
    const file = path.join(folder, "short.spr");
    await spherule("run", "billiards", "--for", "1", "--device", "cpu", "--record", file);
    const player = await play(file, { tokens });
    const page = await enter(browser, player, tokens.viewer);
    await page.waitForSelector(control("timeline"));
    assert.equal(await page.isDisabled(control("timeline")), true);
    assert.match(await page.getAttribute(control("timeline"), "title"), /not steer/);
    assert.equal(await page.isDisabled(control("speed")), true);
    await page.close();
    await player.stop();
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test("the controls go from one page to another, asked for, kept, withdrawn, handed over and released", async () => {
  const one = await enter(browser, server, tokens.controller);
  const two = await enter(browser, server, tokens.controller);
  const number = (page) => page.evaluate(() => spherule.session);
  const [first, second] = [await number(one), await number(two)];
  assert.equal(await one.isVisible(control("control")), false, "nobody has them, nothing is shown");

  await one.click(control("pause"));
  await stands(one, "mine");
  await says(one, "control", /^You have the controls\s*Release$/);
  await says(two, "control", new RegExp(`^spherule viewer\\s*#${first} has the controls`));
  assert.equal(await two.isDisabled(control("pause")), true);
  await two.keyboard.press("Space");
  await two.keyboard.press("r");
  assert.deepEqual(await toasts(two), [`Not donespherule viewer #${first} has the controls`]);

  await two.click(control("control-ask"));
  await says(two, "control", /^Asked; waiting for/);
  await says(one, "control", new RegExp(`#${second} asks`));
  await two.click(control("control-withdraw"));
  await says(one, "control", /^You have the controls\s*Release$/);
  await two.waitForSelector(control("control-ask"));
  assert.equal((await toasts(two)).some((words) => /keeps/.test(words)), false, "who withdrew needs no answer");

  await two.click(control("control-ask"));
  await one.click(control("control-keep"));
  await two.waitForSelector(control("control-ask"));
  await says(two, "toasts", new RegExp(`#${first} keeps the controls`));

  await two.click(control("control-ask"));
  await one.click(control("control-hand-over"));
  await stands(two, "mine");
  await stands(one, "taken");
  await says(two, "toasts", /You have the controls/);
  assert.equal(await two.isDisabled(control("pause")), false);
  assert.equal(await one.isDisabled(control("pause")), true);
  await two.click(control("pause"));
  await when(two, () => spherule.results.at(-1)?.outcome === "applied");

  await two.click(control("control-release"));
  await stands(one, "free");
  await stands(two, "free");
  await one.click(control("reset"));
  await stands(one, "mine");
  await one.close();
  await stands(two, "free");
  assert.deepEqual([...one.faults, ...two.faults], []);
  await two.close();
});

test("names are shown as text, those alike told apart, and nothing covers anything however many ask", async () => {
  const page = await enter(browser, server, tokens.controller, { size: [1280, 800] });
  await page.click(control("pause"));
  await stands(page, "mine");
  const others = [];
  for (const name of ["<img src=x onerror=alert(1)>", "twin", "twin", `long ${"name ".repeat(40)}`, "\u202efifth"]) others.push(await join(server, name));
  await says(page, "control", /and 2 more/);
  const words = await text(page, "control");
  assert.match(words, /<img src=x onerror=alert\(1\)> asks/);
  assert.equal(await page.locator(".steering img").count(), 0);
  const numbers = await page.locator(".steering i").allTextContents();
  assert.equal(new Set(numbers).size, 2);
  assert.equal(await page.locator(control("control-hand-over")).count(), 3);
  for (const { width, faults } of await collisionsByWidth(page, 5)) assert.deepEqual(faults, [], `${width} px`);
  for (const other of others) other.close();
  await says(page, "control", /^You have the controls\s*Release$/);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a server that is full is asked again until there is room", async () => {
  const small = await serve("billiards", { tokens, options: ["--max-sessions", "1"] });
  const first = await enter(browser, small, tokens.viewer);
  const page = await visit(browser, small.url);
  await give(page, tokens.viewer);
  await says(page, "refusal", /^The server says: the limit of open sessions is reached$/);
  await says(page, "connection", /^offline, trying again in \d+ s$/);
  assert.ok((await small.metric('spherule_rejected_total{cause="sessions"}')) > 0);
  await first.close();
  await shows(page);
  await says(page, "connection", /^connected$/);
  await page.close();
  await small.stop();
});

test("a server that turns the page away is quoted, and asked again", async () => {
  const proxy = await proxyTo(server.port);
  try {
    const page = await enter(browser, proxy, tokens.viewer);
    proxy.stutter(true);
    proxy.reset();
    proxy.restore();
    await says(page, "refusal", /^The server says: hello was sent before$/);
    await says(page, "connection", /^offline, trying again/);
    proxy.stutter(false);
    await page.waitForSelector(control("refusal"), { state: "hidden" });
    await says(page, "connection", /^connected$/);
    await page.close();
  } finally {
    proxy.close();
  }
});
