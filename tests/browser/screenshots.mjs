// Takes the picture of docs/images/page.png: node tests/browser/screenshots.mjs FOLDER (SPHERULE names the binary). Not a test.
// The server simulates in real time while the picture is taken.
import { control, launch, open, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";

const folder = process.argv[2] ?? "docs/images";
const server = await serve("rapids");
const browser = await launch();
const page = await open(browser, server.url, {
  size: [1280, 720],
  deviceScaleFactor: 0.5,
  picture: "full",
  colour: "group",
});
await when(page, () => spherule.session.newest.simTime > 8);
await when(page, (factor) => parseFloat(document.querySelector(factor).textContent) > 0.98, control("status-factor"));
await page.mouse.move(640, 60); // the page loads the tools
await page.waitForSelector(control("gravity-arrow"));
await page.waitForTimeout(1000);
await page.screenshot({ path: `${folder}/page.png`, timeout: 120_000 });
await browser.close();
await server.stop();
