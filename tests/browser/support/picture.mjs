// Pixels of the page's canvas.
import { evaluateLarge } from "./browser.mjs";

/**
 * Takes a screenshot of the canvas without the elements over it. `at(x, y)` returns the sRGB colour (0..255) at a CSS
 * pixel. `data`: all pixels, four bytes each, row after row.
 */
export async function pictureOf(page) {
  // The page's security policy forbids style sheets and requests, but allows images in data addresses.
  const setVisibility = (visibility) =>
    page.evaluate((value) => (document.querySelector(".page").style.visibility = value), visibility);
  await setVisibility("hidden");
  const shot = await page.screenshot({ scale: "css", timeout: 120_000 });
  const decode = async (encoded) => {
    const image = new Image();
    image.src = `data:image/png;base64,${encoded}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return { width: image.width, data: Array.from(context.getImageData(0, 0, image.width, image.height).data) };
  };
  const { width, data } = await evaluateLarge(page, decode, shot.toString("base64"));
  await setVisibility("");
  return {
    data,
    at(x, y) {
      const start = 4 * (Math.round(y) * width + Math.round(x));
      return data.slice(start, start + 3);
    },
  };
}

/** The share of pixels whose colours in two pictures differ by more than `levels` (0..255). */
export function shareOfDifferent(one, other, levels) {
  let different = 0;
  for (let k = 0; k < one.data.length; k += 4) {
    if ([0, 1, 2].some((part) => Math.abs(one.data[k + part] - other.data[k + part]) > levels)) different += 1;
  }
  return different / (one.data.length / 4);
}

/** The distance of a colour from grey, 0..1. */
export function vividness([r, g, b]) {
  return (Math.max(r, g, b) - Math.min(r, g, b)) / 255;
}
