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
const [low, high] = [at - 1, at + 1];
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
const plane = {
  channel: 1,
  colour: "#10c010",
  shape: { case: "plane", value: { point: middle(0, 0, -0.9), normal: [0, 0, 2] } },
  pivot: middle(0.5, 0, -0.4),
  axis: [0.6, 0.8, 0],
  ends: true, // at the bounds
  distance: (p) => p[2] - (at - 0.9),
};

/** The obstacle that each pixel shows, as its colour channel; -1: none. `places`: the angle and move of each. */
function expectedIn(camera, bodies, places) {
  const rayAt = rays(camera, ...size);
  return (column, row) => {
    const { near, direction } = rayAt(column, row);
    const origin = plus(camera.eye, near);
    let [found, nearest] = [-1, 10];
    bodies.forEach(({ channel, pivot, axis, ends, distance, shape }, k) => {
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
      const point = origin.map((x, axisOf) => x + along * direction[axisOf]);
      if (ends && point.some((x) => x < low || x > high)) return;
      if (along < nearest) [found, nearest] = [channel, along];
    });
    return found;
  };
}

/** The channel of a colour whose components differ by this share; -1: they do not. */
function channelOf([r, g, b], share) {
  const most = Math.max(r, g, b);
  return most - Math.min(r, g, b) > share * most && most > 20 ? [r, g, b].indexOf(most) : -1;
}

/** Checks that each pixel shows what is expected there, or within two pixels of it. `share`: see channelOf(). */
async function check(page, bodies, places, share = 0.5) {
  const camera = await page.evaluate(() => spherule.camera);
  const expected = expectedIn(camera, bodies, places);
  const picture = await pictureOf(page);
  const seen = bodies.map(() => 0);
  const wrong = [];
  for (let row = 0; row < size[1]; row++) {
    for (let column = 0; column < size[0]; column++) {
      const drawn = channelOf(picture.at(column, row), share);
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
  const page = await open(suite.browser, `${url}?tier=fine`, {
    size,
    deviceScaleFactor: 0.5,
    reducedMotion: "reduce",
    colour: "group",
  });
  await page.evaluate(() => (document.querySelector(".page").style.display = "none")); // the picture has all the room
  await ticks(page, 6);
  return page;
}

const quaternion = (axis, angle) => [...axis.map((x) => x * Math.sin(angle / 2)), Math.cos(angle / 2)];

/** The pose of an obstacle as a message. */
function poseOf({ pivot, axis }, obstacle, { angle, move }) {
  const translation = minus(plus(pivot, move), turned(pivot, axis, angle));
  return { obstacle, translation, rotation: quaternion(axis, angle) };
}

const camera = { eye: middle(1.6, -3, 2.2), target: middle(0, 0, -0.1), fieldOfView: 40 };

/** Shows a scene of its own on the page, between two states. The page then ignores the server's scene. */
function showScene({ scene, poses }) {
  const copies = 60; // of the states, in which the page learns how much time is between them
  const between = 1e9; // ms: the image does not change during the test
  const { session } = spherule;
  const radii = new Uint8Array(Float32Array.of(0.01).buffer);
  session.handle({ kind: "scene", facts: { ...scene, radii } });
  session.handle({ kind: "order", order: { epoch: scene.epoch, number: 1, places: Uint32Array.of(0) } });
  for (let k = 1; k <= copies; k++) {
    const position = {
      values: Int32Array.of(99, 99, -99),
      quantum: 0.01,
      quanta: [0.01, 0.01, 0.01],
      turns: [0, 0, 0],
    };
    const content = {
      columns: { position },
      order: 1,
      boxes: Float64Array.of(-1, -1, -1, 1, 1, 1),
      poses: poses[k % 2],
    };
    const arrival = performance.timeOrigin + performance.now() - (copies + 0.9 - k) * between;
    const times = { sequence: k, epoch: scene.epoch, step: k, simTime: k, arrival, ready: 0 };
    session.handle({ kind: "frame", frame: { ...times, ...content, count: 1, population: 0, bytes: 0 } });
  }
}

test("between two states, boxes, cylinders and planes that move are drawn between their poses", async () => {
  const bodies = [box, cylinder, plane];
  const ends = [
    [
      { angle: 0.1, move: [0, 0, 0] },
      { angle: 0.4, move: [0, 0, 0.2] },
      { angle: -0.1, move: [0, 0, 0] },
    ],
    [
      { angle: 0.5, move: [0.2, 0.1, 0.2] },
      { angle: 1.1, move: [0, 0, 0.6] },
      { angle: 0.4, move: [3, 1, 0.2] },
    ],
  ];
  const obstacles = bodies.map(({ colour, shape, pivot }) => ({ colour, shape, translation: [], motion: { pivot } }));
  const still = {
    shape: { case: "sphere", value: { centre: middle(0, 0.9, 0.9), radius: 0.05, hollow: false } },
    translation: [],
  };
  const scene = {
    ...{ epoch: 1000, name: "", description: "", count: 1, radius: 0, obstacles: [still, ...obstacles] },
    ...{ boundsMin: middle(-1, -1, -1), boundsMax: middle(1, 1, 1), open: [], periodic: [] },
    ...{ groups: [], places: [], population: 0, cells: [], cellSize: 0, camera, meshes: [] },
  };
  const poses = ends.map((places) => places.map((place, k) => poseOf(bodies[k], k + 1, place)));
  const server = await serve("two-spheres");
  const page = await openSmall(server.url);
  await page.evaluate(showScene, { scene, poses });
  await ticks(page, 6);
  const { time, from, to } = await page.evaluate(() => spherule.shown);
  const mix = (time - from) / (to - from);
  assert.ok(mix > 0.2 && mix < 0.95, `mix ${mix}`);
  const [begin, end] = [ends[from % 2], ends[to % 2]];
  const between = (a, b) => a + mix * (b - a);
  const now = begin.map(({ angle, move }, k) => ({
    angle: between(angle, end[k].angle),
    move: move.map((x, axis) => between(x, end[k].move[axis])),
  }));
  await check(page, bodies, now, 0.12); // the states are old, so the page shows them in pale colours
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
});

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
