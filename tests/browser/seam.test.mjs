import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { open, pause, settled, when } from "./support/browser.mjs";
import { pictureOf } from "./support/picture.mjs";
import { queryServer } from "./support/raw.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

const length = 2.4; // m, of the periodic axis x
const speed = 8; // m/s along it: a third of the length in a step
const radius = 0.1; // m

/** One blue sphere that flies along x through a periodic scene, in steps of 0.1 s, from `x` on (m). */
function sceneFile(x) {
  const scene = {
    gravity: [0, 0, 0],
    step: 0.1,
    bounds: { min: [0, 0, 0], max: [length, 1, 1], periodic: ["X"] },
    camera: { eye: [length / 2, -3.5, 0.5], target: [length / 2, 0.5, 0.5] },
    groups: [
      {
        name: "flyer",
        colour: "#2040ff",
        list: { spheres: [{ position: [x, 0.5, 0.5], velocity: [speed, 0, 0] }] },
        radius: { constant: radius },
      },
    ],
  };
  const file = path.join(suite.folder, "flyer.json");
  writeFileSync(file, JSON.stringify(scene));
  return file;
}

/** Runs `body` with a page that shows the sphere, and the server. */
async function withFlyer(x, body) {
  const server = await serve(sceneFile(x));
  try {
    const page = await open(suite.browser, server.url, { colour: "group", size: [480, 270], deviceScaleFactor: 0.5 });
    await body(page, server);
    assert.deepEqual(page.faults, []);
    await page.close();
  } finally {
    await server.stop();
  }
}

/** The places on the sphere's path (m, from -0.2 on, every 2 cm) at which the picture has its colour. */
async function bluePlaces(page) {
  const places = Array.from({ length: 141 }, (_, k) => -0.2 + 0.02 * k);
  const points = await page.evaluate((xs) => xs.map((x) => spherule.project([x, 0.5, 0.5])), places);
  const picture = await pictureOf(page);
  return places.filter((_, k) => {
    const [r, , b] = picture.at(...points[k]);
    return b > r + 40;
  });
}

const onPath = (x) => ((x % length) + length) % length;

test("a sphere does not fly across the picture when it crosses a seam", async () => {
  await withFlyer(0.3, async (page, server) => {
    await server.ctl("set", "speed", "0.03");
    await server.ctl("reset");
    const shownTime = () => page.evaluate(() => spherule.shown.time);
    await when(page, () => spherule.session.frames > 8); // the page knows how far states are apart
    await server.ctl("set", "speed", "0.015"); // a picture may take seconds on a busy machine
    const crosses = ([way, fast]) => {
      if (!spherule.shown) return false; // the simulation has just been reset
      const { time, from, to } = spherule.shown;
      const lengths = (at) => Math.floor((0.3 + fast * at) / way);
      return lengths(from) < lengths(to) && time < 0.6 * from + 0.4 * to;
    };
    let pictures = 0;
    for (let crossing = 0; crossing < 12 && pictures < 1; crossing++) {
      await when(page, crosses, [length, speed]);
      const before = await shownTime();
      const drawn = await page.evaluate(() => spherule.drawn);
      await when(page, (earlier) => spherule.drawn >= earlier + 2, drawn); // the picture is not of an earlier time
      const blue = await bluePlaces(page);
      const after = await shownTime();
      if (after < before || after - before > 0.1) continue; // the machine was busy
      pictures += 1;
      const begin = 0.3 + speed * before;
      const way = speed * (after - before);
      // Every coloured place is within a radius of the path since the shown time was read.
      for (const x of blue) {
        const ahead = onPath(x - begin + radius + 0.1);
        assert.ok(ahead < way + 2 * radius + 0.2, `${x} is coloured, the sphere is at ${onPath(begin)} + ${way}`);
      }
      assert.ok(blue.length > 3, "the sphere is drawn");
    }
    assert.ok(pictures > 0, "no picture between two states on both sides of the seam");
  });
});

test("a sphere on a seam is drawn, and can be picked, on both sides", async () => {
  const x = 0.03; // m
  await withFlyer(x, async (page, server) => {
    await server.ctl("pause");
    await server.ctl("reset");
    await when(page, () => spherule.session.newest?.step === 0);
    await settled(page);
    const picked = await page.evaluate(
      (xs) => xs.map((at) => spherule.at(...spherule.project([at, 0.5, 0.5]))),
      [onPath(x + length / 2), 0.02, length - 0.02],
    );
    assert.deepEqual(picked, [undefined, 0, 0]);
    const blue = await bluePlaces(page);
    assert.ok(blue.some((place) => place < 0.05) && blue.some((place) => place > length - 0.05));
    assert.ok(!blue.some((place) => place > 0.3 && place < length - 0.3));
  });
});

test("a client that knows no turns gets the same positions", async () => {
  await withFlyer(0.3, async (page) => {
    await pause(page);
    const { step, positions, quantum } = await queryServer(page);
    await when(page, (newest) => spherule.session.newest?.step === newest, step);
    const [seen] = (await page.evaluate(() => spherule.positions([0]))).positions;
    assert.ok(positions[0][0] >= 0 && positions[0][0] <= length, "the image inside the bounds");
    positions[0].forEach((value, axis) => assert.ok(Math.abs(value - seen[axis]) < 1.01 * quantum, `axis ${axis}`));
  });
});
