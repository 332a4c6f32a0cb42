// node tools/bench_decode_browser.mjs FOLDER...: times the page's decoder in a worker of headless Chromium, on a page
// that draws nothing. Each FOLDER is an output of `spherule_codec_bench --frames FOLDER`. Requires the packages of
// tests/browser.
import * as esbuild from "esbuild";
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import path from "node:path";
import { launch } from "../../tests/browser/support/browser.mjs";
import { root } from "./options.mjs";

const rounds = 10;
const folders = process.argv.slice(2);
if (folders.length === 0) throw new Error("no folders given");

const { outputFiles } = await esbuild.build({
  entryPoints: [path.join(root, "tools/bench_worker.ts")],
  bundle: true,
  format: "iife",
  target: "es2022",
  minify: true,
  write: false,
});

/** Serves page, worker and frames. Its pages are isolated, which gives them a clock of high resolution. */
const server = createServer((request, response) => {
  response.setHeader("Cross-Origin-Opener-Policy", "same-origin");
  response.setHeader("Cross-Origin-Embedder-Policy", "require-corp");
  const [, folder, file] = request.url.split("/");
  if (file) return response.end(readFileSync(path.join(folders[folder], file)));
  response.setHeader("Content-Type", folder ? "text/javascript" : "text/html");
  return response.end(folder ? outputFiles[0].contents : "<!doctype html><title>bench</title>");
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

const browser = await launch();
try {
  console.log(`Chromium ${browser.version()}`);
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  for (const [index, folder] of folders.entries()) {
    const frames = [];
    while (existsSync(path.join(folder, `frame-${frames.length}.spb`))) {
      frames.push(`${index}/frame-${frames.length}.spb`);
    }
    const spheres = readFileSync(path.join(folder, "frame-0.spb")).readUInt32LE(4);
    const times = await page.evaluate(
      (task) =>
        new Promise((resolve, reject) => {
          const worker = new Worker("worker.js");
          worker.onmessage = ({ data }) => resolve(data);
          worker.onerror = ({ message }) => reject(new Error(message));
          worker.postMessage(task);
        }),
      { frames, order: `${index}/order.u32`, rounds },
    );
    for (const [what, all] of Object.entries(times)) {
      all.sort((a, b) => a - b);
      const at = (share) => (all[Math.floor(share * (all.length - 1))] ?? NaN).toFixed(1);
      const figures = `median ${at(0.5)} ms, p10 ${at(0.1)}, p90 ${at(0.9)}, fastest ${at(0)}`;
      console.log(`${folder}: ${spheres} spheres, ${what}: ${figures}; ${all.length} frames`);
    }
  }
} finally {
  await browser.close();
  server.close();
}
