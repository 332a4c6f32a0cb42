// node tools/bench_picture.mjs [--counts 50000,200000] [--images 3] [--shots FOLDER] [--pick COUNT]: times images of a
// pile of spheres, drawn by this page's renderer and by three.js. That draws an InstancedMesh of 320 triangles per
// sphere, with equal smoothing and shadows. Both run one after the other in one headless Chromium. Each figure is the
// median of three warmed runs. With --pick it times instead how the sphere at a pixel is found, among COUNT: by the
// image, and by the rays of all spheres. Requires the packages of tests/browser.
import * as esbuild from "esbuild";
import { writeFileSync } from "node:fs";
import { createServer } from "node:http";
import path from "node:path";
import { parseArgs } from "node:util";
import { launch } from "../../tests/browser/support/browser.mjs";
import { root } from "./options.mjs";

const { values } = parseArgs({
  options: {
    counts: { type: "string", default: "50000,200000" },
    images: { type: "string", default: "3" },
    shots: { type: "string" },
    pick: { type: "string" },
  },
});

const { outputFiles } = await esbuild.build({
  absWorkingDir: root,
  entryPoints: ["tools/bench_picture_page.ts"],
  nodePaths: [path.join(root, "../tests/browser/node_modules")],
  bundle: true,
  format: "iife",
  target: "es2022",
  write: false,
  loader: { ".glsl": "text" },
});
const server = createServer((request, response) => {
  const isPage = request.url === "/";
  response.setHeader("Content-Type", isPage ? "text/html" : "text/javascript");
  response.end(isPage ? '<!doctype html><body><script src="page.js"></script>' : outputFiles[0].contents);
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

const browser = await launch();
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  page.setDefaultTimeout(600_000);
  page.on("pageerror", (error) => console.error(error.message));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  if (values.pick) {
    const tries = 31;
    const given = [Number(values.pick), tries];
    const { byImage, byRays, agree } = await page.evaluate((both) => window.pick(...both), given);
    console.log(`${values.pick} spheres: ${byImage.toFixed(2)} ms by the image, ${byRays.toFixed(2)} ms by all rays;`);
    console.log(`${(byRays / byImage).toFixed(0)} times faster, medians of ${tries}; ${agree} found the same sphere`);
  }
  const triangles = await page.evaluate(() => window.triangles());
  console.log(`Chromium ${browser.version()}, 1280 x 720; three.js with ${triangles} triangles per sphere`);
  const counts = values.pick ? [] : values.counts.split(",").map(Number);
  for (const count of counts) {
    for (const full of [false, true]) {
      const times = { own: [], three: [] };
      for (let run = 0; run < 3; run++) {
        for (const name of ["own", "three"]) {
          await page.evaluate((given) => window.prepare(...given), [name, count, full]);
          times[name].push(await page.evaluate((images) => window.time(images), Number(values.images)));
          const file = `${name}-${count}-${full ? "full" : "light"}.png`;
          if (values.shots) writeFileSync(path.join(values.shots, file), await page.screenshot({ timeout: 120_000 }));
        }
      }
      const [own, three] = [median(times.own), median(times.three)];
      const quality = full ? "full " : "light";
      const ratio = (three / own).toFixed(1);
      const figures = `${own.toFixed(0)} ms, three.js ${three.toFixed(0)} ms: ${ratio} times cheaper`;
      console.log(`${count} spheres, ${quality}: ${figures}`);
    }
  }
} finally {
  await browser.close();
  server.close();
}
