// What can be seen on a page, pixel by pixel.

/** The page's picture without the controls that lie over it. `at(x, y)` gives sRGB, 0..255, at CSS pixels. */
export async function pictureOf(page) {
  // What the page's security policy allows: no style sheets, no requests, but images that are in their own address.
  const cover = (visibility) => page.evaluate((value) => (document.getElementById("page").style.visibility = value), visibility);
  await cover("hidden");
  const shot = await page.screenshot({ scale: "css", timeout: 120_000 });
  const { width, data } = await page.evaluate(async (encoded) => {
    const image = new Image();
    image.src = `data:image/png;base64,${encoded}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return { width: image.width, data: Array.from(context.getImageData(0, 0, image.width, image.height).data) };
  }, shot.toString("base64"));
  await cover("");
  return {
    at(x, y) {
      const start = 4 * (Math.round(y) * width + Math.round(x));
      return data.slice(start, start + 3);
    },
  };
}

/** How far a colour is from grey, 0..1. */
export function vividness([r, g, b]) {
  return (Math.max(r, g, b) - Math.min(r, g, b)) / 255;
}
