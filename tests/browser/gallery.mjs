// Takes the pictures of the gallery: node tests/browser/gallery.mjs [SCENE...] (SPHERULE names the binary). Not a test.
// Each shows a scene of server/scenes at a chosen time of a recorded run, so that it is the same on every machine.
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { cameraRests, launch, open, settled, when } from "./support/browser.mjs";
import { play, spherule } from "./support/server.mjs";

const views = {
  "rapids-3k": { time: 6 },
  "rapids-6k": { time: 6 },
  "rapids-50k": { time: 4 },
  pour: { time: 0.8 },
  hopper: { time: 3 },
  fountain: { time: 6.5 },
  galton: { time: 6, zoom: 1 },
  drum: { time: 5 },
  "ball-mill": { time: 4 },
  conveyor: { time: 14 },
  "marble-run": { time: 8 },
  press: { time: 5 },
  mixer: { time: 8 },
  screw: { time: 10 },
  piston: { time: 4.3 },
  silo: { time: 3.5 },
  sieve: { time: 4 },
  avalanche: { time: 3 },
  billiards: { time: 0.45, zoom: 1 },
  cradle: { time: 0.25 },
  "cradle-touching": { time: 0.25 },
  bounce: { time: 1.35, zoom: 1 },
  "two-spheres": { time: 0.35, zoom: 1 },
  "box-4k": { time: 0.5, colour: "height" },
  "box-10k": { time: 0.5, colour: "height" },
  "box-50k": { time: 0.5, colour: "height" },
  hourglass: { time: 24, zoom: 1, readme: true },
  "brazil-nut": { time: 20, zoom: 2 },
  "snow-globe": { time: 2.4, zoom: 2, readme: true },
  landslide: { time: 5, zoom: 1, readme: true },
  gas: { time: 1.6, zoom: 1, readme: true },
  sorter: { time: 14 },
  tornado: { time: 9, zoom: 1 },
  "bowl-1m": { time: 0.7, zoom: 2, quality: "light" },
  "stress-1m": { time: 0, colour: "height", quality: "light" }, // in full quality, software takes minutes for it
}; // time: s; zoom: steps towards the scene; readme: README shows a larger picture, too
const small = { size: [360, 225], most: 6000 }; // px; bytes of a picture
const large = { size: [720, 450], most: 40_000 };
const scenes = fileURLToPath(new URL("../../server/scenes", import.meta.url));
const target = fileURLToPath(new URL("../../web-viewer/src/page/scenes", import.meta.url));
const images = fileURLToPath(new URL("../../docs/images", import.meta.url));

const folder = mkdtempSync(path.join(tmpdir(), "spherule-gallery-"));
const browser = await launch();
const wanted = process.argv.slice(2);
for (const [name, { time, zoom = 0, quality = "full", colour, readme }] of Object.entries(views)) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  const file = path.join(folder, `${name}.sph`);
  const scene = path.join(scenes, `${name}.json`);
  await spherule("run", scene, "--device", "cpu", "--for", `${time + 0.05}s`, "--record", file);
  const server = await play(file);
  const [width, height] = readme ? [1440, 900] : [960, 600]; // px of the page; the picture has half as many
  const page = await open(browser, server.url, {
    size: [width, height],
    deviceScaleFactor: 0.5,
    picture: quality,
    colour,
  });
  await server.ctl("pause");
  await server.ctl("seek", String(time));
  await when(page, (then) => Math.abs((spherule.shown?.time ?? -1) - then) < 0.04, time);
  for (let k = 0; k < zoom; k++) await page.keyboard.press("+");
  await page.evaluate(() => (document.querySelector(".page").style.display = "none")); // the scene fills the window
  await page.waitForTimeout(500); // the camera learns of it
  await cameraRests(page);
  await settled(page);
  const shot = await page.screenshot({ clip: { x: 0, y: 0, width, height }, timeout: 0 });
  for (const [place, { size, most }] of [[target, small], ...(readme ? [[images, large]] : [])]) {
    const picture = await page.evaluate(compressed, [shot.toString("base64"), ...size, most]);
    writeFileSync(path.join(place, `${name}.webp`), Buffer.from(picture.split(",")[1], "base64"));
  }
  await page.close();
  await server.stop();
}
await browser.close();
rmSync(folder, { recursive: true });

/** Runs in the page. Returns the picture in the best quality that is small enough, as a data address. */
async function compressed([png, w, h, bytes]) {
  const image = new Image();
  image.src = `data:image/png;base64,${png}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [w, h];
  const context = canvas.getContext("2d");
  context.imageSmoothingQuality = "high";
  context.drawImage(image, 0, 0, w, h);
  for (let quality = 0.9; ; quality -= 0.05) {
    const encoded = canvas.toDataURL("image/webp", quality);
    if (encoded.length * 0.75 < bytes || quality < 0.1) return encoded;
  }
}
