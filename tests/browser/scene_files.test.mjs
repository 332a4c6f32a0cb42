// Scene files: saved from the page, dropped on it, and written in it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { control, open, pause, says, when } from "./support/browser.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve, spherule } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
let page;
const suite = browserSuite(async (browser) => {
  server = await serve("cradle");
  page = await open(browser, server.url, { size: [1280, 800] });
});

const scene = {
  name: "dropped",
  bounds: { min: [-1, -1, 0], max: [1, 1, 2] },
  groups: [{ name: "one", radius: { constant: 0.1 }, list: { spheres: [{ position: [0, 0, 1] }] } }],
};

/** Drops a file on the page. */
async function dropFile(name, text) {
  await page.evaluate(
    ([title, content]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([content], title));
      window.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, cancelable: true }));
    },
    [name, text],
  );
}

/** Replaces the text of the editor. */
async function write(text) {
  await page.locator(`${control("editor")} .cm-content`).click();
  await page.keyboard.press("Control+A");
  await page.keyboard.insertText(text);
}

test("a saved scene is the present state", async () => {
  await server.ctl("set", "gravity", "0", "0", "-3");
  await page.waitForTimeout(700);
  await pause(page);
  const before = await queryServer(page);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(control("save-scene"))]);
  assert.equal(download.suggestedFilename(), "cradle.json");
  const file = path.join(suite.folder, "cradle.json");
  await download.saveAs(file);
  const saved = JSON.parse(readFileSync(file, "utf8"));
  assert.deepEqual(saved.gravity, [0, 0, -3]);
  const positions = saved.groups.flatMap((group) => group.list.spheres.map((sphere) => sphere.position));
  assert.equal(positions.length, before.positions.length);
  positions.forEach((position, id) =>
    position.forEach((part, axis) => assert.ok(Math.abs(part - before.positions[id][axis]) <= before.quantum)),
  );
  // Dropped on the page, it gives the same state again, still paused.
  assert.match(await spherule("plan", file), /spheres/);
  const epoch = await page.evaluate(() => spherule.session.facts.epoch);
  await dropFile("cradle.json", readFileSync(file, "utf8"));
  await when(page, (before) => spherule.session.facts.epoch !== before, epoch);
  const after = await queryServer(page);
  assert.equal(after.step, 0);
  after.positions.forEach((position, id) =>
    position.forEach((part, axis) => assert.ok(Math.abs(part - before.positions[id][axis]) <= 2 * before.quantum)),
  );
  assert.deepEqual(after.settings.gravity, [0, 0, -3]);
});

test("a scene file that is dropped on the page is loaded", async () => {
  await dropFile("one.JSON", JSON.stringify(scene));
  await says(page, "scene-name", /^dropped$/);
  assert.equal(await page.evaluate(() => spherule.spheres), 1);
  assert.equal(await page.isVisible(control("editor")), false);
});

test("faults of a scene file are shown at their lines, and the present scene goes on", async () => {
  const text = JSON.stringify({ ...scene, name: "faulty" }, null, 2);
  await dropFile("faulty.json", text.replace('"constant"', '"constent"'));
  await page.waitForSelector(`${control("editor")}[open]`);
  const line = text.split("\n").findIndex((one) => one.includes('"constant"')) + 1;
  await says(page, "editor-message", new RegExp(`^Line ${line}: "constent" is not known`));
  // The server refuses a radius that is too large for the bounds, at the line of the sphere.
  await write(text.replace('"constant": 0.1', '"constant": 5'));
  await page.click(control("editor-load"));
  const sphere = text.split("\n").findIndex((one) => one.includes('"position"'));
  await says(page, "editor-message", new RegExp(`^Line ${sphere}: .*outside the bounds`));
  await write(text.replace('"min"', "min"));
  await page.click(control("editor-load"));
  await says(page, "editor-message", /^Line 4: This is not JSON/);
  await write(text.replace(/"list": \{[^]*?\]\s*\}\s*\]\s*\}/, '"csv": {"file": "spheres.csv"}'));
  await page.click(control("editor-load"));
  await says(page, "editor-message", /give the spheres as a list, or start the server with this file/);
  assert.equal(await page.evaluate(() => spherule.session.facts.name), "dropped");
  await write(text);
  await page.click(control("editor-load"));
  await says(page, "scene-name", /^faulty$/);
  assert.equal(await page.isVisible(control("editor")), false);
});

test("a scene is written on the page, and keys of the page do not act meanwhile", async () => {
  await page.click(control("edit-scene"));
  await page.waitForSelector(`${control("editor")}[open]`);
  await write(JSON.stringify({ ...scene, name: "pdr" }));
  await page.click(control("editor-load"));
  await says(page, "scene-name", /^pdr$/);
  assert.equal(await page.evaluate(() => spherule.spheres), 1, "d has dropped nothing");
  await page.click(control("edit-scene"));
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible(control("editor")), false);
  assert.deepEqual(page.faults, []);
});
