// An image costs no upload if only the camera moves, and the page draws nothing at rest.
import assert from "node:assert/strict";
import { test } from "node:test";
import { control, open, pause, settled, when } from "./support/browser.mjs";
import { gasScene } from "./support/gas.mjs";
import { serve } from "./support/server.mjs";
import { browserSuite } from "./support/suite.mjs";

let server;
const suite = browserSuite(async (browser, folder) => {
  server = await serve(await gasScene(folder));
});

/** Counts calls that draw, uploads of data other than uniforms, ticks, and objects that have not been deleted. */
function countCalls() {
  window.calls = { draws: 0, uploads: 0, ticks: 0, objects: 0 };
  const { prototype } = WebGL2RenderingContext;
  const wrap = (name, count) => {
    const original = prototype[name];
    prototype[name] = function (...given) {
      count(given);
      return original.apply(this, given);
    };
  };
  const uniforms = 0x8a11; // UNIFORM_BUFFER
  for (const name of ["drawArrays", "drawArraysInstanced"]) wrap(name, () => (window.calls.draws += 1));
  for (const name of ["texImage2D", "texSubImage2D"]) wrap(name, () => (window.calls.uploads += 1));
  for (const name of ["bufferData", "bufferSubData"]) {
    wrap(name, ([target]) => (window.calls.uploads += target === uniforms ? 0 : 1));
  }
  for (const kind of ["Program", "Shader", "Texture", "Framebuffer", "Renderbuffer", "Buffer", "VertexArray"]) {
    wrap(`create${kind}`, () => (window.calls.objects += 1));
    wrap(`delete${kind}`, () => (window.calls.objects -= 1));
  }
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) => {
    window.calls.ticks += 1;
    return request(callback);
  };
}

test("a camera that moves uploads nothing, and at rest nothing is drawn", async () => {
  const page = await open(suite.browser, server.url, { size: [320, 240], picture: "full", init: countCalls });
  await pause(page);
  await settled(page);
  const calls = () => page.evaluate(() => ({ ...window.calls, drawn: spherule.drawn }));
  const before = await calls();
  await page.focus(control("picture"));
  for (let k = 0; k < 6; k++) {
    const { drawn } = await calls();
    await page.keyboard.press(["ArrowLeft", "ArrowUp", "+"][k % 3]);
    await when(page, (earlier) => spherule.drawn > earlier, drawn);
  }
  await settled(page);
  const moved = await calls();
  assert.ok(moved.drawn >= before.drawn + 6 && moved.draws > before.draws, "images were drawn");
  assert.equal(moved.uploads, before.uploads);
  await page.waitForTimeout(2000);
  const rested = await calls();
  assert.equal(rested.draws, moved.draws);
  assert.equal(rested.uploads, moved.uploads);
  assert.ok(rested.ticks - moved.ticks <= 12, `${rested.ticks - moved.ticks} ticks in 2 s`);
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("another quality or size leaves no object of the former one on the device", async () => {
  const page = await open(suite.browser, server.url, { init: countCalls });
  await pause(page);
  await settled(page);
  const objects = () => page.evaluate(() => window.calls.objects);
  const before = await objects();
  for (const picture of ["Full", "Light"]) {
    await page.selectOption(control("quality"), picture, { force: true }); // in a closed folder
    await settled(page);
  }
  await page.setViewportSize({ width: 800, height: 500 });
  await settled(page);
  assert.equal(await objects(), before);
  await page.close();
});
