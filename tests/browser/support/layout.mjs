// Finds elements of the page that overlap or are cut off.

const narrow = 720; // px: up to this width the panel covers the page

/** Returns the faults as text. It is a fault if fewer than `least` elements are visible. */
export async function collisions(page, least) {
  const { width, height, boxes } = await page.evaluate(() => ({
    width: innerWidth,
    height: innerHeight,
    boxes: Array.from(document.querySelectorAll("#page > *, .facts > *, .controls > *, header > *, .transport > *"))
      .filter((element) => !element.matches(".foot, header, .toasts, dialog"))
      .map((element) => ({
        name: element.className || element.dataset.testid || element.tagName,
        within: element.parentElement.className,
        ...element.getBoundingClientRect().toJSON(),
      }))
      .filter((box) => box.width > 0 && box.height > 0),
  }));
  const faults = boxes.length < least ? [`only ${boxes.length} parts`] : [];
  const apart = (a, b) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
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

/** Returns the faults at widths from a phone to a large screen, with the panel shown and hidden. */
export async function collisionsByWidth(page, least) {
  const found = [];
  for (const width of [360, 390, 480, narrow, narrow + 1, 800, 960, 1079, 1080, 1100, 1280, 1440, 1920]) {
    await page.setViewportSize({ width, height: 800 });
    for (const open of width > narrow ? [true, false] : [false]) {
      await page.evaluate((wanted) => {
        const panel = document.querySelector('[data-testid="panel"]');
        if ((panel.offsetHeight > 0) !== wanted) document.querySelector('[data-testid="panel-toggle"]').click();
      }, open);
      found.push({ width, faults: await collisions(page, least) });
    }
  }
  return found;
}
