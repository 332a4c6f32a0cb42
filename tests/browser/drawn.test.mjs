// The image against an independent computation, pixel by pixel.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { open, settled, ticks, when } from "./support/browser.mjs";
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
    const server = await serve(file);
    const page = await open(suite.browser, `${server.url}?tier=fine`, { size: [240, 136], reducedMotion: "reduce" });
    await page.keyboard.press(" ");
    await when(page, () => spherule.session.paused);
    await page.evaluate(() => (document.querySelector(".page").style.display = "none")); // the picture has all the room
    await settled(page);
    let [different, pixels, shown] = [0, 0, 0];
    for (const [pose, keys] of poses.entries()) {
      for (const key of keys) await page.keyboard.press(key);
      await ticks(page, 3); // with reduced motion, the next image has the pose
      const { camera, drawn } = await page.evaluate(() => ({ camera: spherule.camera, drawn: spherule.places }));
      const { differ, wrong } = compare(drawn, placesSeen(camera, spheres, drawn.width, drawn.height));
      assert.deepEqual(wrong, [], `pose ${pose}`);
      different += differ;
      shown += drawn.places.filter((place) => place >= 0).length;
      pixels += drawn.places.length;
    }
    assert.ok(different < 0.01 * pixels, `${different} of ${pixels} pixels differ, at edges`);
    assert.ok(shown > kind.share * pixels, `only ${shown} of ${pixels} pixels show a sphere`);
    assert.deepEqual(page.faults, []);
    await page.close();
    await server.stop();
  });
}
