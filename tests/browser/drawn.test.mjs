// The image against an independent computation, pixel by pixel.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { evaluateLarge, open, settled, ticks, when } from "./support/browser.mjs";
import { cluster, compare, placesSeen } from "./support/rays.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

const suite = browserSuite();

// Keys that lead from one pose to the next, the first from the scene's own camera.
const poses = [
  [],
  ["ArrowLeft", "ArrowLeft", "ArrowUp"],
  ["+", "+", "+"],
  ["ArrowDown", "ArrowDown", "ArrowDown", "ArrowLeft"],
  ["x"],
  ["o"], // orthographic
  ["ArrowRight", "ArrowRight", "ArrowUp"],
  ["+", "+"],
  ["y"],
  ["o", "z"],
  ["-", "-", "-", "-", "-", "-"],
  ["f", "+", "+", "+"],
];

const mixed = { least: 0.05, ratio: 10, count: 40, share: 0.1 };
const discs = { least: 0.03, ratio: 3, count: 300, share: 0.1 }; // of at most 12 px in most poses
const points = { least: 0.002, ratio: 2, count: 300, share: 0.002 };

/** Runs `body` with a small page of a server. */
async function withPage(scene, body) {
  const server = await serve(scene);
  const page = await open(suite.browser, `${server.url}?tier=fine`, {
    size: [240, 136],
    deviceScaleFactor: 1,
    reducedMotion: "reduce",
  });
  await page.evaluate(() => (document.querySelector(".page").style.display = "none")); // the picture has all the room
  await body(page);
  assert.deepEqual(page.faults, []);
  await page.close();
  await server.stop();
}

/**
 * Checks the image in several poses. `spheres`: where each place has its sphere, and then again for its images.
 * `share`: of the pixels that show a sphere at least.
 */
async function assertDrawn(page, poses, spheres, share) {
  const count = await page.evaluate(() => spherule.spheres);
  let [different, pixels, shown] = [0, 0, 0];
  for (const [pose, keys] of poses.entries()) {
    for (const key of keys) await page.keyboard.press(key);
    await ticks(page, 3); // with reduced motion, the next image has the pose
    const { camera, drawn } = await evaluateLarge(page, () => ({ camera: spherule.camera, drawn: spherule.places }));
    const seen = placesSeen(camera, spheres, drawn.width, drawn.height);
    const placeAt = (column, row) => {
      const found = seen(column, row);
      return found < 0 ? found : found % count;
    };
    const { differ, wrong } = compare(drawn, Object.assign(placeAt, { centreOf: seen.centreOf }));
    assert.deepEqual(wrong, [], `pose ${pose}`);
    different += differ;
    shown += drawn.places.filter((place) => place >= 0).length;
    pixels += drawn.places.length;
  }
  assert.ok(different < 0.01 * pixels, `${different} of ${pixels} pixels differ, at edges`);
  assert.ok(shown > share * pixels, `only ${shown} of ${pixels} pixels show a sphere`);
}

for (const [kind, size, at] of [
  [mixed, 0.002, 0], // radii from 0.1 to 1 mm
  [mixed, 0.002, 1e6],
  [mixed, 1, 1e4],
  [mixed, 2000, 0], // radii from 100 to 1,000 m
  [mixed, 2000, 1e6],
  [discs, 1, 0],
  [discs, 1, 1e6],
  [points, 1, 0],
]) {
  const [low, high] = [size * kind.least, size * kind.least * kind.ratio];
  test(`spheres of ${low} to ${high} m are drawn in their places, ${at} m from the origin`, async () => {
    const spheres = cluster(kind).map(({ position, radius }) => ({
      position: position.map((x) => at + size * x),
      radius: size * radius,
    }));
    const scene = {
      gravity: [0, 0, 0],
      bounds: { min: [at - size, at - size, at - size], max: [at + size, at + size, at + size] },
      groups: [{ name: "cluster", list: { spheres } }],
      camera: { eye: [at + 3 * size, at - 3 * size, at + 2 * size], target: [at, at, at], fieldOfView: 30 },
    };
    const file = path.join(suite.folder, "cluster.json");
    writeFileSync(file, JSON.stringify(scene));
    await withPage(file, async (page) => {
      await page.keyboard.press(" ");
      await when(page, () => spherule.session.paused);
      await settled(page);
      await assertDrawn(page, poses, spheres, kind.share);
    });
  });
}

const half = 5e5; // m, of a box of 1,000 km, in which float32 has steps of 3 cm
const epoch = 1000;

/** Shows a scene of its own on the page, between two states. The page then ignores the server's scene. */
function showScene({ scene, states }) {
  const copies = 60; // of the states, in which the page learns how much time is between them
  const between = 1e9; // ms: the image does not change during the test
  const { session } = spherule;
  const places = Uint32Array.from({ length: scene.count }, (_, k) => k);
  session.handle({ kind: "scene", facts: { ...scene, radii: new Uint8Array(Float32Array.from(scene.radii).buffer) } });
  session.handle({ kind: "order", order: { epoch: scene.epoch, number: 1, places } });
  for (let k = 1; k <= copies; k++) {
    const { values, quanta, turns, box } = states[k % 2];
    const position = { values: Int32Array.from(values), quantum: Math.max(...quanta), quanta, turns };
    const content = { columns: { position }, order: 1, boxes: Float64Array.from(box, (x) => Number(x)), poses: [] };
    const arrival = performance.timeOrigin + performance.now() - (copies + 0.9 - k) * between;
    const times = { sequence: k, epoch: scene.epoch, step: k, simTime: k, arrival, ready: 0 };
    session.handle({ kind: "frame", frame: { ...times, ...content, count: scene.count, population: 0, bytes: 0 } });
  }
}

for (const [where, periodic, middle] of [
  ["far from the middle", [], [262_144.3, -3e5, 2e5]],
  ["at a seam", [1], [half, -3e5, 2e5]],
]) {
  test(`small spheres ${where} of a box of 1,000 km are drawn where double precision puts them`, async () => {
    const length = 2 * half;
    const list = cluster(mixed);
    const turned = (x, axis) => (periodic.includes(axis + 1) ? x - length * Math.floor(x / length + 0.5) : x);
    /** A state in which all spheres have moved by some metres. `steps`: quanta in the length of the box. */
    const stateAt = (by, steps) => {
      const quantum = length / steps;
      const coordinate = (x, axis) => Math.round(turned(middle[axis] + by[axis] + x, axis) / quantum);
      const values = list.flatMap(({ position }) => position.map(coordinate));
      const ends = [Math.min, Math.max].map((end) =>
        [0, 1, 2].map((axis) => end(...values.filter((_, k) => k % 3 === axis)) * quantum),
      );
      const box = ends.flatMap((end, k) =>
        end.map((x, axis) => (periodic.includes(axis + 1) ? (k === 0 ? "-Infinity" : "Infinity") : x)),
      );
      const turns = [1, 2, 3].map((axis) => (periodic.includes(axis) ? steps : 0));
      return { values, quanta: [quantum, quantum, quantum], turns, box };
    };
    const states = [stateAt([0, 0, 0], 1e9), stateAt([0.5, 0.3, -0.2], 7e8)]; // of different tiers
    const scene = {
      ...{ epoch, name: "", description: "", count: list.length, radius: 0, radii: list.map(({ radius }) => radius) },
      ...{ boundsMin: [-half, -half, -half], boundsMax: [half, half, half], open: [], periodic, obstacles: [] },
      ...{ groups: [], places: [], population: 0, cells: [], cellSize: 0 },
      camera: { eye: middle.map((x, axis) => x + [3.011, -3.023, 2.037][axis]), target: middle, fieldOfView: 30 },
    };
    await withPage("two-spheres", async (page) => {
      await page.evaluate(showScene, { scene, states });
      const shown = await page.evaluate(() => spherule.shown);
      const to = shown.to % 2;
      const mix = (shown.time - shown.from) / (shown.to - shown.from);
      assert.ok(mix > 0.2 && mix < 0.95, `mix ${mix}`);
      const metres = (state, k) => states[state].values[k] * states[state].quanta[k % 3];
      const shownAt = (k) => {
        const from = metres(1 - to, k);
        return turned(from + mix * turned(metres(to, k) - from, k % 3), k % 3);
      };
      const spheres = list.map(({ radius }, id) => ({
        position: [0, 1, 2].map((axis) => shownAt(3 * id + axis)),
        radius,
      }));
      const images = spheres.map(({ position: [x, ...rest], radius }) => ({
        position: [x - length * Math.sign(x), ...rest],
        radius: Math.abs(x) + radius >= half ? radius : 0, // only those that reach across the face are drawn
      }));
      // Not orthographic: in float32, its depths do not tell these spheres apart. No zoom: it ends far above them.
      const poses = [[], ["ArrowLeft", "ArrowUp"], ["ArrowDown", "ArrowDown", "ArrowDown"], ["x"], ["y"], ["z"]];
      await assertDrawn(page, poses, periodic.length > 0 ? [...spheres, ...images] : spheres, 0.05);
    });
  });
}
