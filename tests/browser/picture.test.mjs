import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { control, launch, open, pause, settled, when } from "./support/browser.mjs";
import { expectPositionsOfServer } from "./support/agreement.mjs";
import { pictureOf, vividness } from "./support/picture.mjs";
import { serverSays } from "./support/raw.mjs";
import { serve, stopAll } from "./support/server.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await stopAll();
});

async function shown(scene, options, body) {
  const server = await serve(scene);
  try {
    const page = await open(browser, server.url, options);
    await body(page, server);
    assert.deepEqual(page.faults, []);
    await page.close();
  } finally {
    await server.stop();
  }
}

test("every sphere is where the server says", async () => {
  await shown("pour", {}, async (page) => {
    await pause(page);
    await expectPositionsOfServer(page);
  });
});

test("a sphere is drawn where it is, as large as it is, in its group's colour", async () => {
  await shown("two-spheres", { colour: "group", picture: "full" }, async (page) => {
    await pause(page);
    await page.click(control("reset"));
    await when(page, () => spherule.step === 0 && spherule.results.at(-1).what === "Reset");
    await settled(page);
    const said = await serverSays(page);
    const places = await page.evaluate(
      ({ positions, radius }) => {
        const { eye } = spherule.camera;
        return positions.map((centre) => {
          // Beside the centre as seen from the eye: across the line of sight and level.
          const sight = centre.map((value, axis) => value - eye[axis]);
          const across = [sight[1], -sight[0], 0];
          const length = Math.hypot(...across);
          const beside = (radii) => spherule.project(centre.map((value, axis) => value + (radii * radius * across[axis]) / length));
          return { centre: beside(0), inside: [beside(0.9), beside(-0.9)], outside: [beside(1.15), beside(-1.15)] };
        });
      },
      { positions: said.positions, radius: said.facts.radius },
    );
    const picture = await pictureOf(page);
    places.forEach(({ centre, inside, outside }, id) => {
      const [r, , b] = picture.at(...centre);
      if (id === 0) assert.ok(b > r + 30, "the left sphere is blue");
      else assert.ok(r > b + 30, "the right sphere is orange");
      for (const place of inside) assert.ok(vividness(picture.at(...place)) > 0.15, `inside sphere ${id}`);
      for (const place of outside) assert.ok(vividness(picture.at(...place)) < 0.1, `beside sphere ${id}`);
    });
  });
});

test("what is nearer hides what is behind it", async () => {
  await shown("box-4k", { colour: "id" }, async (page) => {
    await when(page, () => spherule.simTime > 0.8);
    await pause(page);
    // From below, where the first layers hide the later ones, against the order in which they are drawn.
    for (let i = 0; i < 6; i++) await page.keyboard.press("ArrowDown");
    await when(page, () => spherule.camera.elevation < -0.8);
    await settled(page);
    // Ids run from the first to the last layer, and so do the colours: blue over green to red.
    const seen = await page.evaluate(() => {
      const found = [];
      const { innerWidth: width, innerHeight: height } = window;
      for (let y = 0.1; y < 0.9; y += 0.02) {
        for (let x = 0.1; x < 0.7; x += 0.02) {
          const id = spherule.at(x * width, y * height);
          if (id !== undefined) found.push({ id, x: x * width, y: y * height });
        }
      }
      return found;
    });
    assert.ok(seen.length > 100, `${seen.length} places show a sphere`);
    const picture = await pictureOf(page);
    let right = 0;
    for (const { id, x, y } of seen) {
      const [r, , b] = picture.at(x, y);
      const warm = r / (r + b);
      if (id < 1300 ? warm < 0.5 : id > 2700 ? warm > 0.5 : true) right += 1;
    }
    assert.ok(right > 0.95 * seen.length, `${right} of ${seen.length} places show the colour of the sphere in front`);
  });
});

test("the picture moves between states", async () => {
  await shown("two-spheres", {}, async (page, server) => {
    await page.click(control("reset"));
    await server.ctl("set", "speed", "0.05"); // so that ten frames take seconds, in which even a busy machine draws some pictures
    const drawnBefore = await page.evaluate(() => spherule.picture.drawn);
    const framesBefore = await page.evaluate(() => spherule.frames);
    await when(page, (then) => spherule.frames > then + 10, framesBefore);
    assert.ok((await page.evaluate(() => spherule.picture.drawn)) > drawnBefore + 5);
  });
});
