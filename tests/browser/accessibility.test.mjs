// The page for people who use a keyboard, assistive software, a touch screen, forced colours or reduced motion.
import assert from "node:assert/strict";
import path from "node:path";
import { test } from "node:test";
import { axeFaults, faintParts } from "./support/axe.mjs";
import { clickSphere, control, open, patience, pause, visit, when } from "./support/browser.mjs";
import { enter, prompt, tokens } from "./support/entrance.mjs";
import { collisions, showPanel } from "./support/layout.mjs";
import { play, serve, spherule } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

// Colours of the canvas without spheres, from top to bottom, in renderer/theme.ts.
const canvas = {
  light: [
    [0xe9, 0xed, 0xf0],
    [0xd3, 0xda, 0xdf],
    [0xcd, 0xd4, 0xd9],
    [0xd9, 0xde, 0xe1],
  ],
  dark: [
    [0x2a, 0x32, 0x39],
    [0x17, 0x1c, 0x21],
    [0x24, 0x2c, 0x33],
    [0x36, 0x41, 0x4a],
  ],
};

/** The same colours in a stale picture, as in composite.frag.glsl. */
const stale = (theme) =>
  canvas[theme].map((colour) => {
    const grey = 0.3 * colour[0] + 0.59 * colour[1] + 0.11 * colour[2];
    const haze = 255 * { light: 0.9, dark: 0.1 }[theme];
    return colour.map((part) => 0.25 * part + 0.75 * (0.75 * grey + 0.25 * haze));
  });

let server;
let page; // paused
const suite = browserSuite(async (browser) => {
  server = await serve("cradle");
  page = await open(browser, server.url);
  page.setDefaultTimeout(20_000);
  await pause(page);
});

/** Checks the page in both themes, on a screen and on a phone. `arrange` runs after each change of the size. */
async function expectAccessible(other, arrange = () => {}) {
  for (const [width, height] of [
    [1280, 720],
    [390, 844],
  ]) {
    await other.setViewportSize({ width, height });
    await arrange();
    for (const colorScheme of ["light", "dark"]) {
      await other.emulateMedia({ colorScheme });
      await when(other, (theme) => document.documentElement.dataset.theme === theme, colorScheme);
      const where = `${width} x ${height}, ${colorScheme}`;
      assert.deepEqual(await axeFaults(other), [], where);
      assert.deepEqual(await faintParts(other, [...canvas[colorScheme], ...stale(colorScheme)]), [], where);
    }
  }
}

test("the page with the panel is accessible", () => expectAccessible(page, () => showPanel(page, true)));

test("the page without the panel is accessible", () => expectAccessible(page, () => showPanel(page, false)));

test("the help is accessible", async () => {
  await page.click(control("help"));
  await page.waitForSelector(`${control("help-overlay")}[open]`);
  await expectAccessible(page);
  await page.keyboard.press("Escape");
});

test("the gallery is accessible, also for a viewer", async () => {
  const watched = await serve("cradle", { tokens });
  const watcher = await enter(suite.browser, watched, tokens.viewer);
  for (const other of [page, watcher]) {
    await showPanel(other, true);
    await other.click(control("scenes"));
    await other.waitForSelector(`${control("gallery")}[open]`);
    await expectAccessible(other);
    await other.keyboard.press("Escape");
  }
  await watcher.close();
  await watched.stop();
});

test("a selected sphere is accessible", async () => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.click(control("home"));
  await page.waitForTimeout(1500); // the camera moves
  await clickSphere(page, 2);
  await page.waitForSelector(control("inspected"));
  await expectAccessible(page, () => showPanel(page, true));
});

test("the editor of scenes is accessible, also with a fault", async () => {
  await showPanel(page, true);
  await page.click(control("edit-scene"));
  await page.waitForSelector(`${control("editor")}[open]`);
  await page.keyboard.press("Control+A");
  await page.keyboard.insertText('{"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, "grops": []}');
  await page.click(control("editor-load"));
  await when(page, (selector) => document.querySelector(selector).textContent !== "", control("editor-message"));
  await expectAccessible(page);
  await page.keyboard.press("Escape");
});

test("a pulled sphere is accessible", async () => {
  await page.click(control("reset"));
  await showPanel(page, true);
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.selectOption(control("tool"), "Pull");
  await page.click(control("home"));
  await page.waitForTimeout(1500); // the camera moves
  await clickSphere(page, 2);
  await page.focus(control("picture"));
  await page.keyboard.press("ArrowUp");
  await page.waitForSelector(control("pull-force"));
  await expectAccessible(page, () => showPanel(page, true));
  await page.keyboard.press("Escape");
  await page.selectOption(control("tool"), "Select");
});

test("the timeline of a recording is accessible", async () => {
  const file = path.join(suite.folder, "cradle.sph");
  await spherule("run", "cradle", "--for", "1s", "--record", file, "--device", "cpu");
  const other = await open(suite.browser, (await play(file, { options: ["--paused"] })).url);
  await expectAccessible(other, () => showPanel(other, true));
  await other.close();
});

test("the token dialog is accessible", async () => {
  const other = await visit(suite.browser, (await serve("cradle", { tokens })).url);
  await other.waitForSelector(prompt);
  await expectAccessible(other);
  await other.close();
});

test("the page without a connection is accessible", async () => {
  const own = await serve("cradle");
  const other = await open(suite.browser, own.url);
  await own.stop();
  await when(other, () => spherule.session.connection === "waiting");
  await expectAccessible(other, () => showPanel(other, true));
  await other.close();
});

/** Describes the focused element: faults in how its focus is shown, and whether it had the focus before. */
function focused() {
  const { activeElement: element } = document;
  if (!element || element === document.body) return undefined;
  const { outlineStyle, outlineWidth } = getComputedStyle(element);
  const { left, right, top, bottom } = element.getBoundingClientRect();
  const hit = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
  const faults = [];
  if (outlineStyle === "none" || parseFloat(outlineWidth) < 2) faults.push("its focus is invisible");
  if (element.dataset.testid !== "picture" && !(hit && (element.contains(hit) || hit.contains(element))))
    faults.push("is covered");
  if (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight) faults.push("is cut off");
  const name = element.dataset.testid ?? element.textContent.trim() ?? element.tagName;
  const again = "reached" in element.dataset;
  element.dataset.reached = "";
  return { name, faults, again };
}

for (const size of [
  [1280, 720],
  [390, 844],
  [640, 360],
]) {
  test(`at ${size.join(" x ")}, the tab key reaches every control, and the focus is visible`, async () => {
    await page.setViewportSize({ width: size[0], height: size[1] });
    await showPanel(page, true);
    await page.evaluate(() => {
      for (const element of document.querySelectorAll("[data-reached]")) delete element.dataset.reached;
    });
    const faults = [];
    for (let stops = 0; stops < 150; stops++) {
      await page.keyboard.press("Tab");
      const at = await page.evaluate(focused);
      if (at?.again) break;
      if (at) faults.push(...at.faults.map((fault) => `${at.name} ${fault}`));
    }
    assert.deepEqual(faults, []);
    const missed = await page.evaluate(() =>
      Array.from(document.querySelectorAll("button, input, select, canvas"))
        .filter((element) => element.checkVisibility() && !element.disabled && !("reached" in element.dataset))
        .map((element) => element.dataset.testid ?? element.outerHTML),
    );
    assert.deepEqual(missed, []);
  });
}

test("the help scrolls with arrow keys", async () => {
  await page.setViewportSize({ width: 640, height: 360 });
  await page.focus(control("picture"));
  await page.keyboard.press("?");
  await page.waitForSelector(`${control("help-overlay")}[open]`);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))); // drawn
  const top = () => page.$eval(control("help-overlay"), (element) => element.scrollTop);
  assert.equal(await top(), 0);
  // A busy browser may drop a key while it lays out the dialog.
  const end = Date.now() + patience;
  while ((await top()) <= 20) {
    assert.ok(Date.now() < end, "the help does not scroll");
    await page.keyboard.press("ArrowDown");
    await page.waitForTimeout(200);
  }
  await page.keyboard.press("Escape");
});

test("fingers have large controls", async () => {
  const touch = { hasTouch: true, isMobile: true };
  for (const size of [
    [390, 844],
    [844, 390],
  ]) {
    const other = await open(suite.browser, server.url, { size, ...touch });
    await showPanel(other, true);
    assert.deepEqual(await collisions(other, 5), []);
    const small = await other.evaluate(() =>
      ["transport button", "panel button", "panel select", "panel input:not([type=checkbox])"]
        .flatMap((selector) => Array.from(document.querySelectorAll(`.${selector}`)))
        .filter((element) => element.checkVisibility())
        .map((element) => [element.dataset.testid ?? element.textContent, element.getBoundingClientRect()])
        .filter(([, { width, height }]) => width < 32 || height < 36)
        .map(([name, { width, height }]) => `${name}: ${width} x ${height}`),
    );
    assert.deepEqual(small, []);
    await other.close();
  }
});

test("the theme follows the system until the user chooses one", async () => {
  const other = await open(suite.browser, server.url, { colorScheme: "light" });
  const theme = () => other.evaluate(() => document.documentElement.dataset.theme);
  assert.equal(await theme(), "light");
  await other.emulateMedia({ colorScheme: "dark" });
  await when(other, () => document.documentElement.dataset.theme === "dark");
  assert.equal(await other.$eval(control("theme"), (select) => select.selectedOptions[0].text), "Dark");
  await other.selectOption(control("theme"), "Light");
  assert.equal(await theme(), "light");
  await other.emulateMedia({ colorScheme: "light" });
  await other.emulateMedia({ colorScheme: "dark" });
  await other.waitForTimeout(300);
  assert.equal(await theme(), "light");
  await other.close();
});

test("with reduced motion, nothing moves by itself, and folders open and close", async () => {
  const other = await open(suite.browser, server.url, { reducedMotion: "reduce", size: [1280, 720] });
  const lasting = await other.evaluate(() =>
    Array.from(document.querySelectorAll("*"), (element) => getComputedStyle(element))
      .flatMap(({ animationDuration, transitionDuration }) => `${animationDuration}, ${transitionDuration}`.split(", "))
      .filter((duration) => parseFloat(duration) > 0.001),
  );
  assert.deepEqual(lasting, []);
  const folder = other.locator(".folder > summary", { hasText: "World" });
  await folder.click();
  await when(other, (selector) => !document.querySelector(selector).checkVisibility(), control("friction"));
  await folder.click();
  await other.waitForSelector(control("friction"));
  await other.close();
});

test("forced colours keep edges, states and the colour scale", async () => {
  const forced = { forcedColors: "active", colorScheme: "dark", size: [1280, 720] };
  const other = await open(suite.browser, server.url, { ...forced, colour: "speed" });
  assert.equal(await other.evaluate(() => document.documentElement.dataset.theme), "dark");
  const style = (selector, name) => other.$eval(selector, (element, key) => getComputedStyle(element)[key], name);
  for (const plate of [".panel", ".legend", ".transport", ".panel select", ".many", control("restitution")]) {
    assert.equal(await style(plate, "borderTopStyle"), "solid", plate);
  }
  assert.match(await style(".bar", "backgroundImage"), /gradient/);
  assert.match(await style(control("dial"), "backgroundImage"), /gradient/);
  await other.focus(control("friction"));
  assert.equal(await style(control("friction"), "outlineStyle"), "solid");
  assert.deepEqual(other.faults, []);
  await other.close();
});
