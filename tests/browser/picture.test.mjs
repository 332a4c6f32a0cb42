import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { expectPositionsOfServer } from "./support/agreement.mjs";
import { control, evaluateLarge, open, pause, settled, when } from "./support/browser.mjs";
import { pictureOf, shareOfDifferent, vividness } from "./support/picture.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

/** Runs `body` with a page that shows the scene. */
async function withPage(scene, options, body) {
  const server = await serve(scene);
  try {
    const page = await open(suite.browser, server.url, { deviceScaleFactor: 1, ...options });
    await body(page, server);
    assert.deepEqual(page.faults, []);
    await page.close();
  } finally {
    await server.stop();
  }
}

test("the page has the positions that the server sends", async () => {
  await withPage("pour", {}, async (page) => {
    await pause(page);
    await expectPositionsOfServer(page);
  });
});

test("a sphere is drawn with its position, size and colour", async () => {
  await withPage("two-spheres", { colour: "group", picture: "full" }, async (page) => {
    await pause(page);
    await page.click(control("reset"));
    await when(page, () => spherule.session.newest?.step === 0 && spherule.reports.at(-1).name === "Reset");
    await settled(page);
    const state = await queryServer(page);
    const places = await page.evaluate(
      ({ positions, radius }) => {
        const { eye } = spherule.camera;
        return positions.map((centre) => {
          // Points beside the centre as seen from the eye: horizontal, and perpendicular to the line of sight.
          const sight = centre.map((value, axis) => value - eye[axis]);
          const across = [sight[1], -sight[0], 0];
          const length = Math.hypot(...across);
          const beside = (radii) => {
            const offset = (radii * radius) / length;
            return spherule.project(centre.map((value, axis) => value + offset * across[axis]));
          };
          return { centre: beside(0), inside: [beside(0.9), beside(-0.9)], outside: [beside(1.15), beside(-1.15)] };
        });
      },
      { positions: state.positions, radius: state.facts.radius },
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

const small = [480, 270]; // px; software draws it fast

/** A file with a still scene whose origin lies at `at` on each axis (m): spheres among obstacles of all shapes. */
function sceneAt(at) {
  const point = (...from) => from.map((value) => value + at);
  const spheres = Array.from({ length: 60 }, (_, k) => ({
    position: point(0.3 + 0.35 * (k % 5), 0.3 + 0.35 * (Math.floor(k / 5) % 4), 0.3 + 0.4 * Math.floor(k / 20)),
  }));
  const scene = {
    name: "still", // the picture lies beside the name
    gravity: [0, 0, 0],
    bounds: { min: point(0, 0, 0), max: point(2, 2, 2) },
    obstacles: [
      { plane: { point: point(1.8, 0, 0), normal: [-1, 0, 1] } },
      { box: { min: point(0.1, 1.5, 0), max: point(0.5, 1.9, 0.6) } },
      { sphere: { centre: point(1, 1.7, 0.2), radius: 0.2 } },
      { cylinder: { from: point(1.3, 1.65, 0.2), to: point(1.3, 1.9, 0.7), radius: 0.1 } },
    ],
    camera: { eye: point(4, -3, 3), target: point(1, 1, 0.7) },
    groups: [{ name: "still", colour: "#e06020", list: { spheres }, radius: { constant: 0.12 } }],
  };
  const file = path.join(suite.folder, `at-${at}.json`);
  writeFileSync(file, JSON.stringify(scene));
  return file;
}

test("pictures 10 km and 1,000 km from the origin equal the one at the origin", async () => {
  const pictures = [];
  for (const at of [0, 1e4, 1e6]) {
    await withPage(sceneAt(at), { colour: "group", picture: "full", size: small }, async (page) => {
      await pause(page);
      await settled(page);
      pictures.push(await pictureOf(page));
    });
  }
  const [origin, ...far] = pictures;
  for (const picture of far) {
    const share = shareOfDifferent(origin, picture, 8);
    assert.ok(share < 1e-4, `${share} of the pixels differ`);
  }
});

/** The picture of one orange sphere of 1 m around the origin, from an eye that looks along x or against it. */
async function pictureFrom(eye, ahead) {
  const scene = {
    gravity: [0, 0, 0],
    bounds: { min: [-4, -4, -4], max: [4, 4, 4], open: ["X_MIN", "X_MAX", "Y_MIN", "Y_MAX", "Z_MIN", "Z_MAX"] },
    camera: { eye: [eye, 0, 0], target: [eye + ahead, 0, 0] },
    groups: [
      { name: "large", colour: "#f06010", list: { spheres: [{ position: [0, 0, 0] }] }, radius: { constant: 1 } },
    ],
  };
  const file = path.join(suite.folder, "large.json");
  writeFileSync(file, JSON.stringify(scene));
  let picture;
  await withPage(file, { colour: "group", picture: "full", size: small }, async (page) => {
    await pause(page);
    await settled(page);
    picture = await pictureOf(page);
  });
  return picture;
}

const places = [
  [240, 135],
  [30, 30],
  [450, 30],
  [30, 240],
  [450, 240],
];

test("a camera inside a large sphere or beside it draws it", async () => {
  for (const [eye, ahead, drawn] of [
    [0.4, 0.1, true], // inside
    [-0.9, 0.1, true],
    [-1.02, 0.01, true], // beside it, towards it
    [-1.02, -0.01, false], // away from it
  ]) {
    const picture = await pictureFrom(eye, ahead);
    for (const place of places) {
      const vivid = vividness(picture.at(...place)) > 0.15;
      assert.equal(vivid, drawn, `from ${eye} m towards ${eye + ahead} m, at ${place}: ${picture.at(...place)}`);
    }
  }
});

test("near spheres hide those behind them", async () => {
  await withPage("box-4k", { colour: "id" }, async (page) => {
    await when(page, () => spherule.session.newest?.simTime > 0.8);
    await pause(page);
    // From below, the first layers hide the later ones, against the order of drawing.
    for (let i = 0; i < 6; i++) await page.keyboard.press("ArrowDown");
    await when(page, () => spherule.camera.elevation < -0.8);
    await settled(page);
    // Ids rise from the first layer to the last, and colours with them: from blue to cream. At the edges of spheres,
    // colours are mixed.
    const seen = await evaluateLarge(page, () => {
      const { width, height, places } = spherule.places;
      const found = [];
      for (let y = 2; y < height - 2; y++) {
        for (let x = 2; x < 0.7 * width; x++) {
          const id = places[y * width + x];
          const around = [2, -2, 2 * width, -2 * width].map((step) => places[y * width + x + step]);
          if (id >= 0 && around.every((other) => other === id)) found.push({ id, x, y });
        }
      }
      return found;
    });
    assert.ok(seen.length > 300, `${seen.length} places lie within a sphere`);
    const picture = await pictureOf(page);
    const counts = { first: 0, last: 0, right: 0 };
    for (const { id, x, y } of seen) {
      const [r, , b] = picture.at(x, y);
      const warm = r / (r + b); // about 0.38 and 0.48; highlights are white
      if (id < 1300) counts.first += 1;
      if (id > 2700) counts.last += 1;
      if (id < 1300 ? warm < 0.45 : id > 2700 ? warm > 0.43 : true) counts.right += 1;
    }
    assert.ok(counts.first > 50 && counts.last > 5, JSON.stringify(counts));
    assert.ok(counts.right > 0.95 * seen.length, `${counts.right} of ${seen.length} places have the colour in front`);
  });
});

test("images are drawn while states arrive", async () => {
  await withPage("two-spheres", {}, async (page, server) => {
    await page.click(control("reset"));
    await server.ctl("set", "speed", "0.05");
    const before = await page.evaluate(() => ({ drawn: spherule.drawn, frames: spherule.session.frames }));
    const both = ({ drawn, frames }) => spherule.drawn > drawn + 5 && spherule.session.frames > frames + 10;
    await when(page, both, before);
  });
});
