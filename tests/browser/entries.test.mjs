// Wrong entries on the panel are answered at their fields, by the page and by the server.
import assert from "node:assert/strict";
import { test } from "node:test";
import { chooseScene, control, open, pause, says, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
let page;
browserSuite(async (browser) => {
  server = await serve("billiards");
  page = await open(browser, server.url, { size: [1280, 900] });
  await pause(page);
});

async function enter(id, text) {
  await page.fill(control(id), text);
  await page.press(control(id), "Enter");
}

/** Checks that the field keeps the text and is marked, with this message below it. */
async function expectWrong(id, text, pattern) {
  await says(page, `${id}-wrong`, pattern);
  assert.equal(await page.inputValue(control(id)), text);
  assert.equal(await page.getAttribute(control(id), "aria-invalid"), "true");
  const described = await page.getAttribute(control(id), "aria-describedby");
  assert.match(await page.textContent(`#${described}`), pattern);
}

async function expectRight(id, value) {
  await when(page, (selector) => document.querySelector(selector).hidden, control(`${id}-wrong`));
  assert.equal(await page.getAttribute(control(id), "aria-invalid"), "false");
  assert.equal(await page.getAttribute(control(id), "data-edited"), null);
  assert.equal(await page.inputValue(control(id)), value);
}

const reports = () => page.evaluate(() => spherule.reports.length);

const wrong = [
  ["gravity-x", "fast", /^Give a number from −1\u202f000\u202f000 to 1\u202f000\u202f000\u00a0m\/s²\.$/],
  ["gravity-y", "", /^Give a number from/],
  ["gravity-z", "1e7", /^Give a number from/],
  ["restitution", "1.01", /^Give a number from 0 to 1\.$/],
  ["friction", "-0.1", /^Give a number from 0 to 100\.$/],
  ["speed", "0", /^Give a number from 0\.001 to 1000\u00a0×\.$/],
  ["drop-count", "2.5", /^Give a whole number from 1 to 16\u202f000\u202f000\.$/],
  ["drop-radius", "5 cm", /^Give a number from 1\.0e−6 to \S+\u00a0m\.$/],
  ["impulse", "0", /^Give a number above 0 and up to \S+\u00a0N s\.$/],
];

for (const [id, text, pattern] of wrong) {
  test(`${id}: "${text}" is kept and marked, and nothing is sent; escape restores the value`, async () => {
    const [value, before] = [await page.inputValue(control(id)), await reports()];
    await enter(id, text);
    await expectWrong(id, text, pattern);
    await page.locator(control("legend-next")).focus(); // the field loses the focus, but not the text
    await expectWrong(id, text, pattern);
    await page.focus(control(id));
    await page.keyboard.press("Escape");
    await expectRight(id, value);
    assert.equal(await reports(), before);
  });
}

test("a corrected entry is sent, and a value beyond the slider is not clamped", async () => {
  await enter("friction", "x");
  await expectWrong("friction", "x", /^Give/);
  await enter("friction", "1.5");
  await expectRight("friction", "1.5");
  await when(page, () => spherule.session.settings.friction === 1.5);
});

test("a slider moves its field, and sends its value when it is released; arrow keys move both", async () => {
  const restitution = () => page.evaluate(() => spherule.session.settings.restitution);
  const is = (value) => when(page, (wanted) => spherule.session.settings.restitution === wanted, value);
  await enter("restitution", "x");
  const { x, y, width, height } = await page.locator(control("restitution-slider")).boundingBox();
  const before = await restitution();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width - 1, y + height / 2, { steps: 3 });
  assert.equal(await page.inputValue(control("restitution")), "1");
  assert.equal(await restitution(), before);
  await page.mouse.up();
  await is(1);
  await expectRight("restitution", "1");
  await page.focus(control("restitution-slider"));
  await page.keyboard.press("ArrowLeft");
  await is(0.99);
  await page.focus(control("restitution"));
  await page.keyboard.press("ArrowUp");
  await is(1);
  await page.keyboard.press("ArrowUp"); // there is no larger value
  await page.keyboard.press("Shift+ArrowDown");
  await is(0.9);
  assert.equal(await page.inputValue(control("restitution")), "0.9");
});

test("the goal of automatic quality is checked by its own range", async () => {
  await page.selectOption(control("auto"), "Hold overlap");
  await when(page, () => spherule.session.settings.auto?.goal.case === "overlap");
  await enter("goal", "51");
  await expectWrong("goal", "51", /^Give a number from 1\.0e−4 to 50\u00a0%\.$/);
  await page.keyboard.press("Escape");
  await page.selectOption(control("auto"), "Off");
  await when(page, () => spherule.reports.filter(({ name }) => name === "Automatic").length === 2);
});

test("nothing is dropped or pushed while the field is wrong", async () => {
  const before = await reports();
  await enter("drop-count", "many");
  await page.click(control("drop"));
  assert.equal(await page.evaluate(() => document.activeElement.dataset.testid), "drop-count");
  assert.equal(await reports(), before);
  await page.keyboard.press("Escape");
});

test("a value that the server refuses is answered at the field in the words of the page", async () => {
  await enter("gravity-x", "900000");
  await enter("gravity-y", "900000");
  await expectWrong("gravity-y", "900000", /\S/);
  assert.doesNotMatch(await page.textContent(control("gravity-y-wrong")), /set\.|--/);
  await page.focus(control("gravity-y"));
  await page.keyboard.press("Escape");
  await page.selectOption(control("gravity-preset"), "Earth");
  await when(page, () => spherule.session.settings.gravity[0] === 0);
  await enter("drop-count", "5000000");
  await page.click(control("drop"));
  await says(page, "drop-count-wrong", /^(Too many spheres: at most .+ fit|There is no free place)/);
  await enter("drop-count", "3");
  const spheres = await page.evaluate(() => spherule.spheres);
  await page.click(control("drop"));
  await when(page, (then) => spherule.spheres === then + 3, spheres);
  await expectRight("drop-count", "3");
});

test("another scene brings its own values, and clears wrong entries", async () => {
  await enter("restitution", "x");
  await enter("drop-count", "7");
  await page.selectOption(control("colour"), "Radius");
  await enter("speed", "2");
  await when(page, () => spherule.session.settings.speed === 2);
  await chooseScene(page, "two-spheres");
  await when(page, () => spherule.session.facts.name === "two-spheres" && spherule.session.settings.gravity[2] === 0);
  // From the scene: gravity, materials, count, radius, impulse. From the user: speed, pause, colour.
  await when(page, () => document.querySelector('[data-testid="drop-radius"]').value === "0.05");
  const value = (id) => page.inputValue(control(id));
  assert.deepEqual([await value("gravity-z"), await value("speed"), await value("drop-count")], ["0", "2", "200"]);
  assert.equal(await value("colour"), "Radius");
  assert.equal(await page.evaluate(() => spherule.session.settings.paused), true);
  await when(page, () => document.querySelector('[data-testid="restitution-wrong"]').hidden);
  assert.notEqual(await value("restitution"), "x");
});

test("another client's change is told with its name, and one's own is not", async () => {
  // A busy machine may look at the page after a message has gone.
  await page.evaluate(() => {
    window.told = [];
    new MutationObserver((changes) => {
      for (const { addedNodes } of changes) window.told.push(...[...addedNodes].map((node) => node.textContent));
    }).observe(document.querySelector('[data-testid="toasts"]'), { childList: true });
  });
  const told = (text) =>
    when(page, (what) => told.some((toast) => toast.includes("spherule ctl") && toast.includes(what)), text);
  await server.ctl("set", "gravity", "0", "0", "-1.62");
  await told("set gravity to Moon");
  await page.selectOption(control("gravity-preset"), "Zero");
  await when(page, () => spherule.session.settings.gravity[2] === 0);
  await server.ctl("pause");
  await told("paused the simulation");
  assert.equal(await page.evaluate(() => told.some((toast) => toast.includes("gravity to Zero"))), false);
});
