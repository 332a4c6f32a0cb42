// Finds elements of the page that overlap, are cut off, or cover the scene.
import { control } from "./browser.mjs";

// A phone upright and turned, a tablet, a screen of 1280 x 720 px at a zoom of 200 %, and the same screen at 100 %.
export const sizes = [
  [390, 844],
  [844, 390],
  [768, 1024],
  [640, 360],
  [1280, 720],
];

/** The places of the elements, in the next frame but one: elements may take a frame to follow their containers. */
async function boxesOf(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.evaluate(() => ({
    width: innerWidth,
    height: innerHeight,
    scrolls: document.scrollingElement.scrollWidth > innerWidth || document.scrollingElement.scrollHeight > innerHeight,
    wide: Array.from(document.querySelectorAll("header, .facts > *, .controls > *, .panel, .panel > *, .control"))
      .filter((element) => element.scrollWidth > element.clientWidth)
      .map((element) => element.dataset.control || element.className || element.tagName),
    cut: Array.from(document.querySelectorAll(".field"))
      .filter((element) => {
        const [field, line] = [element.getBoundingClientRect(), element.parentElement.getBoundingClientRect()];
        const isHidden = field.width === 0 || field.top >= line.bottom;
        return !isHidden && (field.left < line.left || field.right > line.right || field.bottom > line.bottom);
      })
      .map((element) => element.className),
    boxes: Array.from(document.querySelectorAll(".page > *, .facts > *, .controls > *, header > *, .transport > *"))
      .filter((element) => !element.matches(".foot, header, .toasts, dialog"))
      .map((element) => ({
        name: element.className || element.dataset.testid || element.tagName,
        within: element.parentElement.className,
        ...element.getBoundingClientRect().toJSON(),
      }))
      .filter((box) => box.width > 0 && box.height > 0),
  }));
}

const apart = (a, b) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;

/** Returns the faults as text. It is a fault if fewer than `least` elements are visible. */
export async function collisions(page, least) {
  const { width, height, scrolls, wide, cut, boxes } = await boxesOf(page);
  const faults = boxes.length < least ? [`only ${boxes.length} parts`] : [];
  faults.push(...wide.map((name) => `the content of ${name} is wider`));
  faults.push(...cut.map((name) => `${name} is cut off`));
  if (scrolls) faults.push("the page scrolls");
  const holds = (a, b) => b.within.startsWith("transport") && a.name === "transport";
  boxes.forEach((box, i) => {
    if (box.left < 0 || box.top < 0 || box.right > width || box.bottom > height) faults.push(`${box.name} is cut off`);
    for (const other of boxes.slice(i + 1)) {
      if (holds(box, other)) {
        if (other.left < box.left || other.right > box.right) faults.push(`${other.name} sticks out of ${box.name}`);
      } else if (!apart(box, other)) faults.push(`${box.name} and ${other.name} overlap`);
    }
  });
  return faults;
}

/** Shows or hides the panel. */
export async function showPanel(page, shown) {
  if ((await page.isVisible(control("panel"))) !== shown) await page.click(control("panel-toggle"));
}

/** Opens the gallery. Returns faults of its layout as text, at its beginning and at its end, and closes it. */
export async function galleryFaults(page) {
  await showPanel(page, true);
  await page.click(control("scenes"));
  await page.waitForSelector(`${control("gallery")}[open]`);
  const faults = await page.evaluate(async (selector) => {
    const gallery = document.querySelector(selector);
    const boxOf = (element) => element.getBoundingClientRect();
    const apart = (a, b) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
    const holds = (a, b) => a.left <= b.left && b.right <= a.right && a.top <= b.top && b.bottom <= a.bottom;
    const overlaps = (boxes) => boxes.some((a, i) => boxes.slice(i + 1).some((b) => !apart(a, b)));
    const close = gallery.querySelector(".close");
    const cards = Array.from(gallery.querySelectorAll("li button"));
    const found = [];
    if (boxOf(document.activeElement).top < boxOf(close).bottom) found.push("the title covers the focused card");
    for (const [place, card] of [
      ["beginning", cards[0]],
      ["end", cards.at(-1)],
    ]) {
      gallery.scrollTop = place === "end" ? gallery.scrollHeight : 0;
      await new Promise(requestAnimationFrame);
      const [window, frame] = [{ left: 0, top: 0, right: innerWidth, bottom: innerHeight }, boxOf(gallery)];
      const reaches = (element) => {
        const { left, top, width, height } = boxOf(element);
        return element.contains(document.elementFromPoint(left + width / 2, top + height / 2));
      };
      if (!holds(window, frame)) found.push(`${place}: the gallery leaves the window`);
      if (!holds(frame, boxOf(close)) || !reaches(close)) found.push(`${place}: its button is out of sight`);
      if (!reaches(card)) found.push(`${place}: ${card.dataset.testid} is out of sight`);
    }
    if (gallery.scrollWidth > gallery.clientWidth) found.push("the gallery scrolls to the side");
    if (overlaps(cards.map(boxOf))) found.push("cards overlap");
    for (const card of cards) {
      const drawn = [...card.children].filter((part) => part.getClientRects().length > 0);
      const parts = drawn.map(boxOf);
      const isWide = ({ scrollWidth, clientWidth }) => clientWidth > 0 && scrollWidth > clientWidth;
      const isCut = [card, ...drawn].some(isWide) || !parts.every((part) => holds(boxOf(card), part));
      if (overlaps(parts)) found.push(`parts of ${card.dataset.testid} overlap`);
      if (isCut) found.push(`${card.dataset.testid} is cut off`);
    }
    return found;
  }, control("gallery"));
  await page.keyboard.press("Escape");
  return faults;
}

/** Returns the faults at widths from a phone to a large screen, with the panel shown and hidden. */
export async function collisionsByWidth(page, least) {
  const found = [];
  for (const width of [360, 390, 480, 720, 721, 800, 960, 1079, 1080, 1100, 1280, 1440, 1920]) {
    await page.setViewportSize({ width, height: 800 });
    for (const open of [true, false]) {
      await showPanel(page, open);
      found.push({ width, faults: await collisions(page, least) });
    }
  }
  return found;
}

/**
 * Waits until the picture has moved to the part of the canvas that is free. Returns which elements cover the rectangle
 * around the bounds of the scene, and whether it leaves the window.
 */
export async function coverings(page) {
  await page.evaluate(async () => {
    const placeOf = () => JSON.stringify(spherule.project(spherule.session.facts.origin));
    for (let still = 0, last; still < 4; still = last === placeOf() ? still + 1 : 0) {
      last = placeOf();
      await new Promise(requestAnimationFrame);
    }
  });
  const scene = await page.evaluate(() => {
    const { min, max } = spherule.session.facts;
    const points = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => min.map((low, axis) => ((k >> axis) & 1 ? max[axis] : low)));
    const places = points.map((point) => spherule.project(point));
    const [xs, ys] = [places.map(([x]) => x), places.map(([, y]) => y)];
    return { left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) };
  });
  const { width, height, boxes } = await boxesOf(page);
  const { left, right, top, bottom } = scene;
  const inside = left >= 0 && top >= 0 && right <= width && bottom <= height;
  const covering = boxes.filter((box) => !apart(box, scene)).map(({ name }) => `${name} covers the scene`);
  const size = Math.max((right - left) / width, (bottom - top) / height);
  return [...(inside ? [] : ["the scene leaves the window"]), ...covering, ...(size < 0.25 ? ["it is tiny"] : [])];
}
