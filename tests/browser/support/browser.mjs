// Chromium with WebGL in software, and pages of it that remember what went wrong in them.
import { chromium } from "playwright-core";
import { serverSays } from "./raw.mjs";

export const patience = 90_000; // ms; software rendering on a busy machine takes its time

/** `more`: switches of Chromium. */
export async function launch(...more) {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-background-networking", ...more],
  });
}

/**
 * Goes to the page. `picture`: what it calls the quality of its picture; `fixed`: it is sent what it asks for, however slowly it
 * draws here.
 */
export async function visit(browser, url, { size = [960, 540], picture = "light", colour = "", fixed = true, ...context } = {}) {
  const page = await browser.newPage({ viewport: { width: size[0], height: size[1] }, ...context });
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

/** Opens the page and waits until it has a state and says what it shows. */
export async function open(browser, url, options) {
  const page = await visit(browser, url, options);
  await shows(page);
  return page;
}

/** Waits until the page has a state and says what it shows. */
export async function shows(page) {
  await when(page, () => {
    const title = document.querySelector('[data-testid="scene-name"]');
    const legend = document.querySelector('[data-testid="legend"]');
    return window.spherule?.frames > 0 && title.textContent === spherule.scene && !legend.hidden;
  });
}

export const control = (id) => `[data-testid="${id}"]`;

/** Waits until the function is true in the page; it sees `argument`. */
export async function when(page, condition, argument) {
  await page.waitForFunction(condition, argument, { timeout: patience, polling: 100 });
}

/** Pauses from the page and waits until it has the state at which the world stands. */
export async function pause(page) {
  if (!(await page.evaluate(() => spherule.paused))) await page.click(control("pause"));
  await when(page, () => spherule.paused);
  const { step } = await serverSays(page);
  await when(page, (stands) => spherule.step === stands, step);
}

/** Waits until the picture shows the newest state: two pictures later nothing is drawn any more. */
export async function settled(page) {
  await page.evaluate(async () => {
    let drawn = -1;
    while (drawn !== spherule.picture.drawn) {
      drawn = spherule.picture.drawn;
      await new Promise((resolve) => setTimeout(resolve, 1500));
    }
  });
}
