// Not a test: node tests/browser/screenshots.mjs OUT takes the screenshots of docs/images. SPHERULE is the path of the
// binary.
import { launch, open, settled, when } from "./support/browser.mjs";
import { serve } from "./support/server.mjs";

const shots = [
  { file: "box-moving.png", scene: "box-10k", steps: 29, colour: "speed" },
  { file: "box-at-rest.png", scene: "box-10k", steps: 360, colour: "speed" },
  { file: "pour.png", scene: "pour", steps: 100, colour: "group" },
];
const out = process.argv[2] ?? "docs/images";
const browser = await launch();
for (const { file, scene, steps, colour } of shots) {
  const server = await serve(scene);
  await server.ctl("pause");
  await server.ctl("reset");
  const page = await open(browser, server.url, { size: [1440, 810], picture: "full", colour });
  await server.ctl("step", String(steps));
  await when(page, (wanted) => spherule.session.newest?.step === wanted, steps);
  await settled(page);
  await page.screenshot({ path: `${out}/${file}`, timeout: 120_000 });
  console.log(file);
  await page.close();
  await server.stop();
}
await browser.close();
