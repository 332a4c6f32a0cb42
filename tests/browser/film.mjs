// Takes the frames of docs/images/collapse.webp: node tests/browser/film.mjs FOLDER (SPHERULE names the binary).
// This is not a test. It plays a recording and waits at each moment until the picture is complete, because software
// rendering is slow.
// This command makes a film at the rate of the simulation:
//
//     img2webp -loop 0 -d 50 -lossy -q 75 -m 6 FOLDER/*.png -o docs/images/collapse.webp
//
// Put -d 1500 before the last frame, to hold it for 1.5 s.
import { mkdirSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { launch, open, settled } from "./support/browser.mjs";
import { play, spherule } from "./support/server.mjs";

const frames = 84;
const perSecond = 20;
const scene = fileURLToPath(new URL("film.json", import.meta.url));
const folder = process.argv[2] ?? "film";
mkdirSync(folder, { recursive: true });
const file = path.join(folder, "collapse.sph");
const seconds = `${frames / perSecond}s`;
await spherule("run", scene, "--for", seconds, "--record", file, "--record-rate", "60", "--force", "--device", "cpu");
const server = await play(file, { options: ["--paused"] });
const browser = await launch();
const page = await open(browser, server.url, {
  size: [960, 740],
  deviceScaleFactor: 0.5,
  picture: "full",
  colour: "id",
});
await page.keyboard.press("c"); // hides the controls, which leaves the whole width to the picture
await page.evaluate(() => (document.querySelector(".page").style.visibility = "hidden"));
for (let k = 0; k < frames; k++) {
  await server.ctl("seek", String(k / perSecond));
  await settled(page);
  await page.screenshot({
    path: path.join(folder, `${String(k).padStart(3, "0")}.png`),
    clip: { x: 80, y: 0, width: 800, height: 560 },
    timeout: 120_000,
  });
}
await browser.close();
await server.stop();
