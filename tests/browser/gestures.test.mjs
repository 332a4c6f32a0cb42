import assert from "node:assert/strict";
import { test } from "node:test";
import { control, open, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
const suite = browserSuite(async () => {
  server = await serve("two-spheres");
});

const camera = (page) => page.evaluate(() => spherule.camera);

async function drag(page, from, to, button = "left") {
  await page.mouse.move(...from);
  await page.mouse.down({ button });
  await page.mouse.move(...to, { steps: 5 });
  await page.mouse.up({ button });
}

test("the mouse orbits, pans and zooms, and the view can be reset", async () => {
  const page = await open(suite.browser, server.url);
  const start = await camera(page);
  await drag(page, [300, 200], [400, 240]);
  await when(
    page,
    ({ azimuth, elevation }) =>
      Math.abs(spherule.camera.azimuth - azimuth) > 0.3 && spherule.camera.elevation > elevation,
    start,
  );
  const orbited = await camera(page);
  await drag(page, [300, 200], [360, 200], "right");
  await when(
    page,
    ({ target }) => spherule.camera.target.some((value, axis) => Math.abs(value - target[axis]) > 0.01),
    orbited,
  );
  await page.mouse.move(300, 250);
  await page.mouse.wheel(0, -300);
  await when(page, (then) => spherule.camera.distance < 0.9 * then.distance, start);
  await page.click(control("home"));
  await when(page, (then) => Math.abs(spherule.camera.distance - then.distance) < 1e-9, start);
  await page.close();
});

test("one finger orbits, and two fingers zoom", async () => {
  const page = await open(suite.browser, server.url, { size: [390, 844], hasTouch: true, isMobile: true });
  const touch = await page.context().newCDPSession(page);
  const send = (type, ...points) =>
    touch.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const start = await camera(page);
  await send("touchStart", [150, 400]);
  for (const x of [170, 200, 240]) await send("touchMove", [x, 400]);
  await send("touchEnd");
  await when(page, (then) => Math.abs(spherule.camera.azimuth - then) > 0.2, start.azimuth);
  await send("touchStart", [150, 400], [250, 400]);
  for (const apart of [20, 60, 90]) await send("touchMove", [150 - apart, 400], [250 + apart, 400]);
  await send("touchEnd");
  await when(page, (then) => spherule.camera.distance < 0.6 * then, start.distance);
  assert.deepEqual(page.faults, []);
  await page.close();
});
