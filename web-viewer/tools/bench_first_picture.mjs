// node tools/bench_first_picture.mjs [--openings 20] [--scene box-50k] [--device cpu] [--play FILE]: opens the page
// repeatedly in one headless Chromium. Prints the time from the opening of the WebSocket until the first keyframe is
// decoded and its image is handed to the browser, and the parts of that time. --play: of a recording. Run it in the
// project's folder, or with SPHERULE set. Requires the packages of tests/browser.
import { parseArgs } from "node:util";
import { launch } from "../../tests/browser/support/browser.mjs";
import { play, serve } from "../../tests/browser/support/server.mjs";

const { values } = parseArgs({
  options: {
    openings: { type: "string", default: "20" },
    scene: { type: "string", default: "box-50k" },
    device: { type: "string", default: "cpu" },
    play: { type: "string" },
  },
});
const marks = ["connecting", "open", "scene", "arrived", "decoded", "drawn"];

/** Opens the page once; returns the times of its performance marks (ms since its opening). */
async function openOnce(browser, url) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  await page.goto(url);
  const isDrawn = () => performance.getEntriesByName("spherule:drawn").length > 0;
  await page.waitForFunction(isDrawn, undefined, { timeout: 60_000 });
  const times = await page.evaluate((names) => {
    const timeOf = (name) => performance.getEntriesByName(`spherule:${name}`)[0]?.startTime;
    return Object.fromEntries(names.map((name) => [name, timeOf(name)]));
  }, marks);
  await page.close();
  return times;
}

function line(what, times) {
  times.sort((a, b) => a - b);
  const at = (share) => (times[Math.round(share * (times.length - 1))] ?? NaN).toFixed(0);
  const figures = `median ${at(0.5)} ms, p90 ${at(0.9)}, fastest ${at(0)}, slowest ${at(1)}`;
  console.log(`${what}: ${figures}; ${times.length} openings`);
}

const server = values.play ? await play(values.play, "--loop") : await serve(values.scene, { device: values.device });
const browser = await launch();
try {
  console.log(`Chromium ${browser.version()}, ${values.play ?? `${values.scene} on ${values.device}`}`);
  const all = [];
  for (let k = 0; k < Number(values.openings); k++) all.push(await openOnce(browser, server.url));
  line(
    "WebSocket opened to picture handed over",
    all.map((one) => one.drawn - one.open),
  );
  for (let k = 1; k < marks.length; k++) {
    const [from, to] = [marks[k - 1], marks[k]];
    line(
      `  ${from} to ${to}`,
      all.map((one) => one[to] - one[from]),
    );
  }
} finally {
  await browser.close();
  await server.stop();
}
