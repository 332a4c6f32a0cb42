// Takes a picture of each state of the page: node tests/browser/state_pictures.mjs OUT [STATE...] (SPHERULE names the
// binary). Not a test. For each state and theme, OUT/STATE/THEME-WIDTHxHEIGHT.png has one size of the window, and
// OUT/STATE.png has all of them: a row for each theme, a column for each size.
//   --sizes 390x844,1280x720    only these sizes
//   --themes light,forced       only these themes
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { parseArgs } from "node:util";
import { launch } from "./support/browser.mjs";
import { sizes as usual } from "./support/layout.mjs";
import { states } from "./support/page_states.mjs";
import { stopAll } from "./support/server.mjs";

const media = {
  light: { colorScheme: "light", forcedColors: "none" },
  dark: { colorScheme: "dark", forcedColors: "none" },
  forced: { colorScheme: "dark", forcedColors: "active" },
};
const sheetWidth = 2000; // px

const options = { sizes: { type: "string" }, themes: { type: "string" } };
const { values, positionals } = parseArgs({ options, allowPositionals: true });
const [out, ...wanted] = positionals;
const sizes = values.sizes?.split(",").map((size) => size.split("x").map(Number)) ?? usual;
const themes = values.themes?.split(",") ?? Object.keys(media);
const unknown = [
  ...wanted.filter((name) => !(name in states)),
  ...themes.filter((name) => !(name in media)),
  ...sizes.filter((size) => size.length !== 2 || !size.every((px) => px > 0)),
];
if (!out || unknown.length > 0) {
  console.error(`usage: node tests/browser/state_pictures.mjs OUT [STATE...] [--sizes WxH,...] [--themes NAME,...]
themes: ${Object.keys(media).join(", ")}
states: ${Object.keys(states).join(", ")}${unknown.length > 0 ? `\nunknown: ${unknown.join(", ")}` : ""}`);
  process.exit(2);
}

const folder = mkdtempSync(path.join(tmpdir(), "spherule-states-"));
const failed = [];
for (const name of wanted.length > 0 ? wanted : Object.keys(states)) {
  const browser = await launch();
  try {
    await picture(browser, name);
    console.log(path.join(out, `${name}.png`));
  } catch (error) {
    failed.push(name);
    console.error(`${name}: ${error.message}`);
  }
  await browser.close();
  await stopAll().catch(() => {}); // some states stop or freeze their server
}
rmSync(folder, { recursive: true });
process.exitCode = failed.length > 0 ? 1 : 0;

/** Takes all pictures of a state, and then their sheet. */
async function picture(browser, name) {
  const { page, arrange = () => {}, end = () => {} } = await states[name]({ browser, folder });
  mkdirSync(path.join(out, name), { recursive: true });
  const rows = [];
  for (const theme of themes) {
    await page.emulateMedia({ ...media[theme], reducedMotion: "reduce" });
    rows.push([]);
    for (const [width, height] of sizes) {
      await page.setViewportSize({ width, height });
      await arrange();
      await page.waitForTimeout(700); // the picture follows the elements, and the elements the size
      const file = path.join(out, name, `${theme}-${width}x${height}.png`);
      await page.screenshot({ path: file, timeout: 120_000 });
      rows.at(-1).push({ file, width, height });
    }
  }
  await end();
  await sheet(browser, rows, path.join(out, `${name}.png`));
}

/** Puts the pictures of a state on one sheet, all at the same scale. */
async function sheet(browser, rows, file) {
  const scale = Math.min(1, sheetWidth / rows[0].reduce((sum, { width }) => sum + width + 8, 0));
  const cell = ({ file: source, width }) =>
    `<img width="${Math.floor(scale * width)}" src="data:image/png;base64,${readFileSync(source).toString("base64")}">`;
  const lines = rows.map((row) => `<div>${row.map(cell).join("")}</div>`);
  const page = await browser.newPage({ viewport: { width: sheetWidth, height: 600 } });
  const style =
    "body { margin: 0; background: #777 } div { display: flex; gap: 6px; padding: 3px; align-items: start }";
  await page.setContent(`<style>${style}</style>${lines.join("")}`);
  await page.screenshot({ path: file, fullPage: true });
  await page.close();
}
