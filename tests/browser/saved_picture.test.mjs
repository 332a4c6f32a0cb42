// Pictures that the user saves.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { control, evaluateLarge, open, pause, ticks, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
let page;
const suite = browserSuite(async (browser) => {
  server = await serve("cradle", { folder: suite.folder });
  page = await open(browser, server.url, {
    size: [900, 700],
    deviceScaleFactor: 0.5,
    colour: "group",
    reducedMotion: "reduce",
  });
  await pause(page);
});

async function enter(id, value) {
  await page.fill(control(id), String(value));
  await page.press(control(id), "Enter");
}

/** Saves a picture. Returns its size, and a function of column and row: the colour (sRGB, 0..255). */
async function saved(width, height) {
  await enter("picture-width", width);
  await enter("picture-height", height);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(control("save-picture"))]);
  assert.match(download.suggestedFilename(), /^cradle-\d{8}-\d{6}\.png$/);
  const encoded = readFileSync(await download.path()).toString("base64");
  const decode = async (data) => {
    const loaded = new Image();
    loaded.src = `data:image/png;base64,${data}`;
    await loaded.decode();
    const canvas = new OffscreenCanvas(loaded.width, loaded.height);
    const context = canvas.getContext("2d");
    context.drawImage(loaded, 0, 0);
    const { data: pixels } = context.getImageData(0, 0, loaded.width, loaded.height);
    return { width: loaded.width, height: loaded.height, pixels: Array.from(pixels) };
  };
  const image = await evaluateLarge(page, decode, encoded);
  const at = (x, y) => image.pixels.slice(4 * (y * image.width + x), 4 * (y * image.width + x) + 3);
  return { width: image.width, height: image.height, at };
}

test("a picture of the asked size has the scene, and its tiles join without a seam", async () => {
  const [width, height] = [2300, 150];
  const picture = await saved(width, height);
  assert.deepEqual([picture.width, picture.height], [width, height]);
  const difference = (x) => {
    let sum = 0;
    for (let y = 0; y < height; y++) {
      const [a, b] = [picture.at(x - 1, y), picture.at(x, y)];
      sum += Math.abs(a[0] - b[0]) + Math.abs(a[1] - b[1]) + Math.abs(a[2] - b[2]);
    }
    return sum / height;
  };
  const beside = [1900, 1905, 1910, 1915, 1925, 1930, 1935, 1940].map(difference);
  assert.ok(difference(1920) <= 2 * Math.max(...beside) + 1, `${difference(1920)} beside ${beside}`);
  const isOrange = ([r, g, b]) => r > b + 60 && r > g + 30;
  const columns = Array.from({ length: width }, (_, x) => x);
  const rows = Array.from({ length: height }, (_, y) => y);
  const orange = columns.filter((x) => rows.some((y) => isOrange(picture.at(x, y))));
  assert.ok(orange.length > 5, "the orange ball is in the picture");
  assert.ok(orange[0] > 0.3 * width && orange.at(-1) < 0.7 * width, "the scene is in the middle");
});

test("the page goes on after a picture, and a picture can be cancelled", async () => {
  const drawn = await page.evaluate(() => spherule.drawn);
  await page.focus(control("picture"));
  await page.keyboard.press("ArrowLeft");
  await when(page, (before) => spherule.drawn > before, drawn);
  await enter("picture-width", 16_000); // nine tiles
  await enter("picture-height", 200);
  let downloads = 0;
  page.on("download", () => (downloads += 1));
  await page.click(control("save-picture"));
  // The page takes events between two tiles only, and page.click() needs many turns.
  await page.evaluate((selector) => document.querySelector(selector).click(), control("drawing-cancel"));
  await when(page, (selector) => document.querySelector(selector).hidden, control("drawing"));
  const then = await page.evaluate(() => spherule.drawn);
  await page.focus(control("picture"));
  await page.keyboard.press("ArrowLeft");
  await when(page, (before) => spherule.drawn > before, then);
  await ticks(page, 10);
  assert.equal(downloads, 0);
  assert.deepEqual(page.faults, []);
});

test("a size that no picture can have is answered at its field", async () => {
  await enter("picture-width", 20000);
  const message = page.locator('[data-control="picture-width"] + .wrong, [data-control="picture-width"] .wrong');
  assert.match(await message.textContent(), /from 16 to 16.384/);
  await page.click(control("save-picture"));
  assert.equal(await page.isVisible(control("drawing")), false);
});
