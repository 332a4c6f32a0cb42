// A new visitor pours, pushes and resets with few actions, and without scrolling.
import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import path from "node:path";
import { beforeEach, afterEach, test } from "node:test";
import { control, open, when } from "./support/browser.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const ball = {
  name: "ball",
  bounds: { min: [-1, -1, 0], max: [1, 1, 1.5], open: ["Z_MAX"] },
  groups: [{ list: { spheres: [{ position: [0, 0, 0.3] }] }, radius: { constant: 0.3 } }],
};

let server;
const suite = browserSuite(async (_, folder) => {
  const file = path.join(folder, "ball.json");
  await writeFile(file, JSON.stringify(ball));
  server = await serve(file);
});

let page;
let actions; // of the visitor
beforeEach(async () => {
  actions = 0;
  page = await open(suite.browser, server.url, { size: [1280, 720] }); // with a profile of its own
});
afterEach(() => page.close());

/** A click at a point of the window. Fails if something else is there. */
async function click([x, y], what) {
  const hit = await page.evaluate(
    ([left, top, selector]) => document.elementFromPoint(left, top)?.closest(selector) !== null,
    [x, y, what],
  );
  assert.ok(hit, `${what} is not visible without scrolling`);
  await page.mouse.click(x, y);
  actions += 1;
}

async function press(id) {
  const box = await page.evaluate((selector) => {
    const { left, top, width, height } = document.querySelector(selector).getBoundingClientRect();
    return [left + width / 2, top + height / 2];
  }, control(id));
  await click(box, control(id));
}

async function applied(command) {
  await when(page, (name) => spherule.reports.some((report) => report.name.startsWith(name)), command);
  const [outcome] = await page.evaluate(
    (name) => spherule.reports.filter((report) => report.name.startsWith(name)).map((report) => report.outcome.case),
    command,
  );
  assert.equal(outcome, "applied");
}

/** The distance of the ball from its place at the beginning (m). */
async function distance() {
  const { positions } = await queryServer(page);
  return Math.hypot(...positions[0].map((part, axis) => part - ball.groups[0].list.spheres[0].position[axis]));
}

test("a visitor pours spheres", async () => {
  const before = (await queryServer(page)).positions.length;
  await press("drop");
  await applied("Drop");
  const { positions } = await queryServer(page);
  assert.ok(positions.length > before, `${positions.length} spheres`);
  assert.ok(actions <= 3, `${actions} actions`);
  await server.ctl("reset");
});

test("a visitor pushes a sphere", async () => {
  assert.ok((await distance()) < 0.02);
  await page.selectOption(control("tool"), "Push");
  actions += 1;
  await click(await page.evaluate(() => spherule.project([0, 0, 0.3])), "canvas");
  await applied("Push");
  await page.waitForTimeout(500);
  assert.ok((await distance()) > 0.1, "the ball is where it was");
  assert.ok(actions <= 3, `${actions} actions`);
});

test("a visitor resets the scene", async () => {
  // The test before has pushed the ball, which rolls to and fro, and may be passing its first place.
  let away = await distance();
  for (let k = 0; k < 50 && away <= 0.1; ++k) {
    await page.waitForTimeout(50);
    away = await distance();
  }
  assert.ok(away > 0.1, "the ball has not been pushed");
  await press("reset");
  await applied("Reset");
  assert.ok((await distance()) < 0.02);
  assert.ok(actions <= 3, `${actions} actions`);
});

test("pause, drop, push, gravity and quality need no scrolling", async () => {
  const wanted = ["pause", "step", "drop-count", "drop-radius", "tool", "impulse", "gravity-preset", "dial"];
  const outOfSight = await page.evaluate((ids) => {
    const isVisible = (id) => {
      const element = document.querySelector(`[data-testid="${id}"]`);
      const { left, top, width, height } = element.getBoundingClientRect();
      const hit = document.elementFromPoint(left + width / 2, top + height / 2);
      return element.contains(hit) || hit?.parentElement === element.parentElement; // an arrow lies over a list
    };
    return ids.filter((id) => !isVisible(id));
  }, wanted);
  assert.deepEqual(outOfSight, []);
});

test("diagnostics are folded until someone asks for them, and then stay open", async () => {
  const title = (name) => page.locator(".folder > summary", { hasText: new RegExp(`^${name}$`) });
  const isOpen = (name) => title(name).evaluate((summary) => summary.parentElement.open);
  for (const name of ["Stream", "Now", "Statistics"]) {
    assert.equal(await isOpen(name), false, name);
  }
  await title("Now").click();
  const figure = page.locator("summary", { hasText: "Overlap, mean" });
  await figure.waitFor();
  await figure.press("Enter");
  await page.getByText("How far touching spheres overlap").waitFor();
  await figure.press("Space");
  await page.getByText("How far touching spheres overlap").waitFor({ state: "hidden" });
  assert.equal(await page.evaluate(() => spherule.session.paused), false, "the figure took the key");
  await page.reload();
  await when(page, () => spherule.session.frames > 0);
  assert.equal(await isOpen("Now"), true);
  assert.equal(await isOpen("Stream"), false);
});
