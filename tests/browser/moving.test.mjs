// Obstacles that move are drawn where they are, pixel by pixel.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { open, settled, ticks, when } from "./support/browser.mjs";
import { pictureOf } from "./support/picture.mjs";
import { rays } from "./support/rays.mjs";
import { play, serve, spherule } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

const at = 1000; // m, on each axis: the middle of the scene
const size = [240, 136]; // px

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((x, k) => x - b[k]);
const plus = (a, b) => a.map((x, k) => x + b[k]);
const middle = (...offset) => offset.map((x) => at + x);

/** Turns a vector about an axis of unit length. */
function turned(vector, axis, angle) {
  const [x, y, z] = axis;
  const [a, b, c] = vector;
  const across = [y * c - z * b, z * a - x * c, x * b - y * a];
  const [cos, sin, along] = [Math.cos(angle), Math.sin(angle), dot(axis, vector)];
  return vector.map((part, k) => cos * part + sin * across[k] + (1 - cos) * along * axis[k]);
}

/** Obstacles in clear colours. `distance`: of a point from one that has not moved (m); less where it is far away. */
const box = {
  channel: 0,
  colour: "#e01010",
  shape: { case: "box", value: { min: middle(-0.9, -0.6, -0.5), max: middle(-0.5, -0.2, 0.1), hollow: false } },
  pivot: middle(0, 0, 0),
  axis: [0, 0, 1],
  distance(p) {
    const out = p.map((x, k) => Math.max(this.shape.value.min[k] - x, x - this.shape.value.max[k]));
    return Math.max(...out);
  },
};
const cylinder = {
  channel: 2,
  colour: "#1010e0",
  shape: {
    case: "cylinder",
    value: { from: middle(0.1, 0.3, 0), to: middle(0.9, 0.3, 0), radius: 0.15, hollow: false, open: false },
  },
  pivot: middle(0.5, 0.3, 0),
  axis: [0, 1, 0],
  distance(p) {
    const [x, y, z] = minus(p, middle(0.5, 0.3, 0));
    return Math.max(Math.abs(x) - 0.4, Math.hypot(y, z) - 0.15);
  },
};
/** The obstacle that each pixel shows, as its colour channel; -1: none. `places`: the angle and move of each. */
function expectedIn(camera, bodies, places) {
  const rayAt = rays(camera, ...size);
  return (column, row) => {
    const { near, direction } = rayAt(column, row);
    const origin = plus(camera.eye, near);
    let [found, nearest] = [-1, 10];
    bodies.forEach(({ channel, pivot, axis, distance, shape }, k) => {
      const { angle, move } = places[k];
      // The ray in the coordinates in which the obstacle has not moved.
      const begin = plus(turned(minus(minus(origin, pivot), move), axis, -angle), pivot);
      const way = turned(direction, axis, -angle);
      let along = 0;
      for (let step = 0; step < 500 && along < nearest; step++) {
        const room = distance.call(
          { shape },
          begin.map((x, axisOf) => x + along * way[axisOf]),
        );
        if (room < 1e-4) break;
        along += Math.max(room, 1e-4);
      }
      if (along < nearest) [found, nearest] = [channel, along];
    });
    return found;
  };
}

/** The channel of a clear colour; -1: none is clear. */
function channelOf([r, g, b]) {
  const most = Math.max(r, g, b);
  return most - Math.min(r, g, b) > 0.5 * most && most > 20 ? [r, g, b].indexOf(most) : -1;
}

/** Checks that each pixel shows what is expected there, or within two pixels of it. */
async function check(page, bodies, places) {
  const camera = await page.evaluate(() => spherule.camera);
  const expected = expectedIn(camera, bodies, places);
  const picture = await pictureOf(page);
  const seen = bodies.map(() => 0);
  const wrong = [];
  for (let row = 0; row < size[1]; row++) {
    for (let column = 0; column < size[0]; column++) {
      const drawn = channelOf(picture.at(column, row));
      const k = bodies.findIndex(({ channel }) => channel === drawn);
      if (k >= 0) seen[k] += 1;
      const near = [-2, -1, 0, 1, 2];
      const isNear = near.some((dy) => near.some((dx) => expected(column + 0.5 + dx, row + 0.5 + dy) === drawn));
      if (!isNear) wrong.push({ column, row, drawn });
    }
  }
  assert.deepEqual(wrong.slice(0, 5), [], `${wrong.length} pixels are wrong`);
  for (const count of seen) assert.ok(count > 150, `obstacles have ${seen} pixels`);
}

async function openSmall(url) {
  const page = await open(suite.browser, `${url}?tier=fine`, { size, reducedMotion: "reduce", colour: "group" });
  await page.evaluate(() => (document.querySelector(".page").style.display = "none")); // the picture has all the room
  await ticks(page, 6);
  return page;
}

const camera = { eye: middle(1.6, -3, 2.2), target: middle(0, 0, -0.1), fieldOfView: 40 };

const spin = 0.5; // rad/s
const oscillation = { amplitude: [0.2, 0.1, 0.3], frequency: 0.25 };

/** Where the obstacles of the scene below are at a time (s). */
const placesAt = (time) => [
  { angle: 0, move: oscillation.amplitude.map((x) => x * Math.sin(2 * Math.PI * oscillation.frequency * time)) },
  { angle: spin * time, move: [0, 0, 0] },
];

function sceneFile() {
  const motions = [
    { oscillations: [oscillation] },
    { spin: cylinder.axis.map((x) => spin * x), pivot: cylinder.pivot },
  ];
  const scene = {
    gravity: [0, 0, 0],
    bounds: { min: middle(-1, -1, -1), max: middle(1, 1, 1) },
    obstacles: [box, cylinder].map(({ colour, shape, pivot }, k) => ({
      colour,
      [shape.case]: shape.value,
      motion: { pivot, ...motions[k] },
    })),
    groups: [{ colour: "#808080", list: { spheres: [{ position: middle(0.9, 0.9, -0.9), radius: 0.02 }] } }],
    camera,
  };
  const file = path.join(suite.folder, "moving.json");
  writeFileSync(file, JSON.stringify(scene));
  return file;
}

/** Checks the picture at some times (s) of a recording. */
async function checkPlayed(file, times) {
  const server = await play(file, { options: ["--paused"] });
  const page = await openSmall(server.url);
  for (const time of times) {
    await server.ctl("seek", String(time));
    await when(page, (wanted) => Math.abs(spherule.session.newest.simTime - wanted) < 0.1, time);
    await settled(page);
    await check(page, [box, cylinder], placesAt(await page.evaluate(() => spherule.shown.time)));
  }
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
}

test("the page and a recording show obstacles of a server where they are at the time of the image", async () => {
  const file = path.join(suite.folder, "live.sph");
  const server = await serve(sceneFile(), { options: ["--record", file] });
  const page = await openSmall(server.url);
  for (let round = 0; round < 2; round++) {
    await when(page, (time) => spherule.session.newest.simTime > time, 1 + round);
    await page.keyboard.press(" ");
    await when(page, () => spherule.session.paused);
    await settled(page); // nothing is drawn while nothing moves
    await check(page, [box, cylinder], placesAt(await page.evaluate(() => spherule.shown.time)));
    await page.keyboard.press(" ");
    await when(page, () => !spherule.session.paused);
  }
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
  await checkPlayed(file, [2, 1]);
});

test("a recorded run shows obstacles where they were, also after a seek back", async () => {
  const file = path.join(suite.folder, "run.sph");
  await spherule("run", sceneFile(), "--for", "4s", "--record", file, "--device", "cpu");
  await checkPlayed(file, [3, 1]);
});
