// The page tells its state: what is missing, what is old, what cannot be used, and what to do.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { control, open, pause, says, unfold, visit, when } from "./support/browser.mjs";
import { collisions } from "./support/layout.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

/** Waits until the page shows the notices with these ids, and no others. */
async function notices(page, ...ids) {
  const shown = (wanted) =>
    Array.from(document.querySelectorAll("[data-notice]"), ({ dataset }) => dataset.notice).join() === wanted;
  await when(page, shown, ids.join());
}

/** The controls that look usable and send commands. */
const usable = (page) =>
  page.evaluate(() => {
    const picture = ["trace", "picture-width", "picture-height", "save-picture"];
    const look = [...picture, "tier", "rate", "fixed", "colour", "quality", "theme", "home", "help", "panel-toggle"];
    const local = [...look, "scenes", "open-file", "copy-link", "timeline", "save"];
    const elements = document.querySelectorAll(".page :is(button, input, select, svg[role])[data-testid]");
    const blocked = (one) => one.disabled || one.ariaDisabled === "true";
    return Array.from(elements)
      .filter((one) => one.checkVisibility() && !blocked(one) && !one.closest("dialog, [data-notice], .legend"))
      .map(({ dataset }) => dataset.testid)
      .filter((id) => !local.includes(id) && id !== "retry");
  });

const reasonOf = (page, id) => page.evaluate((selector) => document.querySelector(selector).title, control(id));

const shot = async (page, name) => {
  if (process.env.SCREENSHOTS) await page.screenshot({ path: path.join(process.env.SCREENSHOTS, `${name}.png`) });
};

test("a scene without spheres says what to do, and the notice drops some", async () => {
  const file = path.join(suite.folder, "empty.json");
  writeFileSync(file, JSON.stringify({ name: "empty", bounds: { min: [-1, -1, 0], max: [1, 1, 2] } }));
  const server = await serve(file);
  const page = await visit(suite.browser, server.url);
  await notices(page, "empty");
  assert.deepEqual(await collisions(page, 5), []);
  await shot(page, "empty");
  await page.click(control("notice-choose"));
  await page.waitForSelector(`${control("gallery")}[open]`);
  await page.keyboard.press("Escape");
  await page.click(control("notice-drop"));
  await when(page, () => spherule.spheres === 200);
  await notices(page);
  await page.close();
  await server.stop();
});

test("a page without a connection looks like one: nothing can be used, and no figure looks new", async () => {
  const server = await serve("billiards");
  const page = await open(suite.browser, server.url);
  await when(page, () => /\d/.test(document.querySelector('[data-testid="status-steps"]').textContent));
  assert.ok((await usable(page)).includes("reset"));
  await server.kill();
  await notices(page, "offline");
  assert.deepEqual(await usable(page), []);
  assert.equal(await reasonOf(page, "reset"), "There is no connection to the server");
  for (const id of ["factor", "steps", "stream", "viewers"]) {
    assert.equal(await page.textContent(control(`status-${id}`)), "–", id);
  }
  assert.ok(await page.evaluate(() => document.querySelector(".page").classList.contains("old")));
  // Keys that send commands tell the reason instead.
  await page.keyboard.press("r");
  await says(page, "toast-text", /^There is no connection to the server$/);
  assert.equal(await page.evaluate(() => spherule.reports.length), 0);
  assert.deepEqual(await collisions(page, 5), []);
  const next = await serve("billiards", { port: server.port });
  // The page may have connected by itself, and then there is no button any more.
  await page.evaluate((button) => document.querySelector(button)?.click(), control("notice-retry"));
  await notices(page);
  assert.ok((await usable(page)).includes("reset"));
  assert.ok(await page.evaluate(() => !document.querySelector(".page").classList.contains("old")));
  await page.close();
  await next.stop();
});

test("a server that does not answer blocks the controls until it does", async () => {
  const server = await serve("billiards");
  const page = await open(suite.browser, server.url);
  await page.mouse.move(10, 10); // the page loads the tools
  const some = ["pause", "gravity-arrow", "gravity-down"];
  for (const id of some) await page.waitForSelector(control(id));
  server.freeze();
  await notices(page, "silent");
  assert.deepEqual(await usable(page), []);
  assert.equal(await reasonOf(page, "pause"), "The server does not answer");
  server.thaw();
  await notices(page);
  const again = await usable(page);
  for (const id of some) assert.ok(again.includes(id), id);
  await page.close();
  await server.stop();
});

test("spheres that left are told with a way back, once per number", async () => {
  const server = await serve("two-spheres");
  await server.ctl("set", "speed", "20");
  const page = await open(suite.browser, server.url);
  await notices(page, "outside");
  await says(page, "notice-title", /^2 spheres left the scene$/);
  await page.click(control("notice-dismiss"));
  await notices(page);
  await page.click(control("reset"));
  await when(page, () => spherule.session.status.outside === 0);
  await notices(page, "outside"); // they have left again
  await pause(page);
  await page.click(control("notice-reset"));
  await notices(page);
  assert.equal(await page.evaluate(() => spherule.session.newest.step), 0);
  await page.close();
  await server.stop();
});

test("a browser without WebGL shows what to do, and figures and controls work", async () => {
  const server = await serve("billiards");
  const page = await suite.browser.newPage();
  await page.addInitScript(() => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      return kind === "webgl2" ? null : getContext.call(this, kind, ...more);
    };
  });
  await page.goto(server.url);
  await notices(page, "no-graphics");
  await unfold(page, "Statistics");
  await when(page, () => /\d/.test(document.querySelector('[data-testid="statistics-kinetic"]')?.textContent));
  await page.click(control("pause"));
  await when(page, () => spherule.session.paused);
  for (const id of ["legend", "home", "colour", "tool"]) assert.equal(await page.isVisible(control(id)), false, id);
  await page.close();
  await server.stop();
});

test("a lost WebGL context is told until the browser gives it back", async () => {
  const server = await serve("billiards");
  const page = await open(suite.browser, server.url);
  await page.evaluate(() => {
    window.loss = document.querySelector("canvas").getContext("webgl2").getExtension("WEBGL_lose_context");
    window.loss.loseContext();
  });
  await notices(page, "graphics-lost");
  const opacity = () => page.evaluate(() => getComputedStyle(document.querySelector("canvas")).opacity);
  assert.equal(await opacity(), "0"); // else it is white
  await page.evaluate(() => window.loss.restoreContext());
  await notices(page);
  await when(page, () => getComputedStyle(document.querySelector("canvas")).opacity === "1");
  await page.close();
  await server.stop();
});

test("an error in the page is shown with a way to reload", async () => {
  const server = await serve("billiards");
  const page = await open(suite.browser, server.url);
  await page.evaluate(() => void setTimeout(() => { throw new Error("something is undefined"); })); // prettier-ignore
  await page.waitForSelector(control("failure"));
  assert.match(await page.textContent(control("failure-details")), /something is undefined/);
  await page.click(control("failure-reload"));
  await when(page, () => window.spherule?.session.frames > 0 && !document.querySelector("dialog.failure"));
  await page.close();
  await server.stop();
});
