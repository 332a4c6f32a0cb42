// Chromium with WebGL in software, whose pages log their errors and requests.
import { chromium } from "playwright-core";
import { queryServer } from "./raw.mjs";

export const patience = 90_000; // ms; software rendering on a busy machine takes its time

/** `more`: further switches of Chromium. */
export async function launch(...more) {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--enable-unsafe-swiftshader",
      "--use-angle=swiftshader",
      "--disable-background-networking",
      ...more,
    ],
  });
}

/**
 * Opens the page. Its image has a quarter as many pixels along each side as the window: with half as many, software
 * takes 0.5 s of processor time for one image. Tests that look at pixels set `deviceScaleFactor`. `picture`: its choice
 * of image quality; `fixed`: the server does not reduce the stream, however slowly the page draws here. `init`: a
 * function that runs in the page before its own code.
 */
export async function visit(browser, url, options = {}) {
  const { size = [960, 540], picture = "light", colour = "", fixed = true, init, ...context } = options;
  const page = await browser.newPage({
    viewport: { width: size[0], height: size[1] },
    deviceScaleFactor: 0.25,
    ...context,
  });
  if (init) await page.addInitScript(init);
  page.setDefaultTimeout(patience);
  page.faults = [];
  page.requested = [];
  page.on("console", (message) => message.type() === "error" && page.faults.push(message.text()));
  page.on("pageerror", (error) => page.faults.push(error.message));
  page.on("request", (request) => page.requested.push(request.url()));
  const address = new URL(url);
  address.searchParams.set("picture", picture);
  if (fixed) address.searchParams.set("fixed", "");
  if (colour) address.searchParams.set("colour", colour);
  await page.goto(address.href);
  return page;
}

/** Opens the page, and waits until it shows a state with its legend. */
export async function open(browser, url, options) {
  const page = await visit(browser, url, options);
  await shows(page);
  return page;
}

/** Waits until the page shows a state with its legend. */
export async function shows(page) {
  await when(page, () => {
    const title = document.querySelector('[data-testid="scene-name"]');
    const legend = document.querySelector('[data-testid="legend"]');
    const { frames, facts } = window.spherule?.session ?? {};
    return frames > 0 && title.textContent === facts.name && !legend.hidden;
  });
}

export const control = (id) => `[data-testid="${id}"]`;

/** Waits until the function, which runs in the page with `argument`, returns true. */
export async function when(page, condition, argument) {
  await page.waitForFunction(condition, argument, { timeout: patience, polling: 100 });
}

/** Evaluates the function in the page, for results with many numbers: Playwright itself takes 10 µs for each. */
export async function evaluateLarge(page, body, argument) {
  return JSON.parse(
    await page.evaluate(`(async () => JSON.stringify(await (${body})(${JSON.stringify(argument)})))()`),
  );
}

/** Waits until the text of the element matches. */
export async function says(page, id, pattern) {
  const matches = ([selector, source]) => new RegExp(source).test(document.querySelector(selector)?.textContent);
  await when(page, matches, [control(id), pattern.source]);
}

/** Pauses the simulation from the page, and waits until the page has its newest state. */
export async function pause(page) {
  if (!(await page.evaluate(() => spherule.session.paused))) await page.click(control("pause"));
  await when(page, () => spherule.session.paused);
  const { step } = await queryServer(page);
  await when(page, (newest) => spherule.session.newest?.step === newest, step);
}

/** Waits until nothing is drawn any more: the image then shows the newest state. */
export async function settled(page) {
  await page.evaluate(async () => {
    let drawn = -1;
    while (drawn !== spherule.drawn) {
      drawn = spherule.drawn;
      await new Promise((resolve) => setTimeout(resolve, 1500));
      for (let k = 0; k < 2; k++) await new Promise(requestAnimationFrame); // what was asked for is drawn
    }
  });
}

/** Chooses a scene from the gallery. */
export async function chooseScene(page, name) {
  await page.click(control("scenes"));
  await page.click(control(`scene-${name}`));
}

/** Opens a folder of the panel that is folded. */
export async function unfold(page, name) {
  await page.click(`.folder:not([open]) > summary:text-is("${name}")`);
}

/** Waits until the camera stands still, after parts of the page have appeared or gone. */
export async function cameraRests(page) {
  await page.evaluate(async () => {
    let [before, same] = ["", 0];
    while (same < 4) {
      await new Promise(requestAnimationFrame);
      const now = String(spherule.camera.toClip);
      same = now === before ? same + 1 : 0;
      before = now;
    }
  });
}

/** Clicks on a sphere, as soon as the image shows it. */
export async function clickSphere(page, id) {
  await cameraRests(page);
  const isDrawn = (one) => {
    const [position] = spherule.positions([one])?.positions ?? [];
    const at = position && spherule.project(position);
    return at !== undefined && spherule.at(...at) === one;
  };
  await when(page, isDrawn, id);
  const at = await page.evaluate((one) => spherule.project(spherule.positions([one]).positions[0]), id);
  await page.mouse.click(...at);
}

/** Waits for this number of ticks of the page. */
export async function ticks(page, count) {
  await page.evaluate(async (number) => {
    for (let k = 0; k < number; k++) await new Promise(requestAnimationFrame);
  }, count);
}
