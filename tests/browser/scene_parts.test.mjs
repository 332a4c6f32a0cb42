// The folder "Scene": fields, emitters, materials and groups that the page adds, changes and removes.
import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { control, open, says, unfold, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const scene = {
  name: "room",
  description: "Spheres float in a room.",
  whatToTry: "Add a wind in the folder Scene.",
  gravity: [0, 0, 0],
  bounds: { min: [-1, -1, 0], max: [1, 1, 1.5] },
  materials: [{ name: "foam", density: 20 }],
  groups: [
    {
      name: "floats",
      lattice: { min: [-1, -0.5, 0.5], max: [-0.5, 0.5, 1], spacing: 0.15 },
      radius: { constant: 0.05 },
    },
  ],
};

let server;
let page;
browserSuite(async (browser, folder) => {
  const file = path.join(folder, "room.json");
  await writeFile(file, JSON.stringify(scene));
  server = await serve(file);
  page = await open(browser, server.url, { size: [1280, 900] });
});

const parts = () => page.evaluate(() => spherule.session.parts);
const picture = async (name) => {
  if (process.env.SPHERULE_SHOTS) await page.screenshot({ path: path.join(process.env.SPHERULE_SHOTS, `${name}.png`) });
};

/** The mean x of all spheres (m). */
const meanX = () =>
  page.evaluate(() => {
    const { positions } = spherule.positions([...Array(18).keys()]);
    return positions.reduce((sum, [x]) => sum + x, 0) / positions.length;
  });

/** Gives an entry another value. */
async function enter(id, text) {
  await page.fill(control(id), text);
  await page.press(control(id), "Enter");
  await page.locator(control(id)).blur();
}

test("the page shows what to try, in the header and in the gallery", async () => {
  assert.equal(await page.textContent(control("what-to-try")), scene.whatToTry);
  assert.ok(await page.isVisible(control("what-to-try")));
  await page.click(control("scenes"));
  assert.match(await page.textContent(control("scene-room")), /Add a wind in the folder Scene/);
  await picture("gallery");
  await page.keyboard.press("Escape");
});

test("the lists are loaded when the folder is opened, and a wind from them blows", async () => {
  const loaded = () => page.requested.some((url) => url.includes("scene_parts"));
  assert.ok(!loaded());
  await unfold(page, "Scene");
  await page.waitForSelector(control("scene-parts"));
  assert.ok(loaded());
  const before = await meanX();
  await page.selectOption(control("field-add"), "Wind");
  await page.waitForSelector(control("field-0-entry"));
  assert.match(await page.textContent(control("field-0-entry")), /^wind/);
  await when(page, () => spherule.session.parts.fields.length === 1);
  await when(
    page,
    (x) => {
      const { positions } = spherule.positions([...Array(18).keys()]);
      return positions.reduce((sum, [one]) => sum + one, 0) / positions.length > x + 0.2;
    },
    before,
  );
  await page.click(`${control("field-0-entry")} > summary`);
  await picture("wind");
});

test("values are changed in fields and as text, and errors of the server stand beside the entry", async () => {
  await enter("field-0-drag-velocity", "0 0 2.5");
  await when(page, () => spherule.session.parts.fields[0].kind.value.velocity[2] === 2.5);
  await enter("field-0-drag-density", "-4");
  await says(page, "field-0-wrong", /[Dd]rag\.density is -4, must be 0 to 100000 kg\/m\^3/);
  assert.ok(await page.isVisible(control("field-0-wrong")));
  await picture("refused");
  assert.equal((await parts()).fields[0].kind.value.density, 1.2);
  await enter("field-0-drag-velocity", "0 zero 1");
  await says(page, "field-0-wrong", /give three numbers/);
  await page.click(`${control("field-0-entry")} .all > summary`);
  await page.fill(control("field-0-text"), '{ "attraction": { "centre": [0, 0, 1], "strengthh": 1 } }');
  await page.click(control("field-0-apply"));
  await says(page, "field-0-wrong", /strengthh/);
  await page.fill(
    control("field-0-text"),
    '{ "attraction": { "centre": [0, 0, 1], "strength": 1, "softening": 0.5 } }',
  );
  await page.click(control("field-0-apply"));
  await when(page, () => spherule.session.parts.fields[0].kind.case === "attraction");
  assert.ok(!(await page.isVisible(control("field-0-wrong"))));
  await page.click(control("field-0-remove"));
  await when(page, () => spherule.session.parts.fields.length === 0);
  assert.equal(await page.locator(control("field-0-entry")).count(), 0);
});

test("emitters, materials and groups are changed in the same way", async () => {
  await page.selectOption(control("emitter-add"), "Rain");
  await when(page, () => spherule.session.facts.population.groups.length === 2);
  await when(page, () => spherule.session.spheres > 25);
  await page.selectOption(control("material-add"), "Rubber");
  await when(page, () => spherule.session.parts.materials.length === 2);
  const [, rubber] = (await parts()).materials;
  await page.waitForSelector(control("group-0-entry"));
  await page.click(`${control("group-0-entry")} > summary`);
  await enter("group-0-material", rubber.name);
  await when(page, () => spherule.session.facts.population.groups[0].material === 1);
  await enter("group-0-colour", "#ff0000");
  await when(page, () => spherule.session.facts.population.groups[0].colour[1] === 0);
  await page.click(`${control("material-1-entry")} > summary`);
  await page.click(control("material-1-remove"));
  await says(page, "material-1-wrong", /of which are groups\[0\]/);
  await page.locator(control("material-1-wrong")).scrollIntoViewIfNeeded();
  await picture("material");
  await page.click(`${control("emitter-0-entry")} > summary`);
  await page.click(control("emitter-0-remove"));
  await when(page, () => spherule.session.parts.emitters.length === 0);
  await page.click(control("group-0-remove"));
  await when(page, () => spherule.session.facts.population.groups.length === 1);
  assert.deepEqual(page.faults, []);
});

test("changes of other clients are shown", async () => {
  await server.ctl("add_field", '{"buoyancy": {"density": 1.2}}').catch(() => undefined); // there is no gravity
  await server.ctl("add_field", '{"drag": {"density": 3}}');
  await page.waitForSelector(control("field-0-entry"));
  assert.equal(await page.inputValue(control("field-0-drag-density")), "3");
  await server.ctl("reset");
  await when(page, () => spherule.session.parts.fields.length === 0 && spherule.session.parts.materials.length === 1);
  assert.equal(await page.locator(control("material-1-entry")).count(), 0);
});
