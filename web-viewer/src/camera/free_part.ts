import type { Insets } from "./view";

/** A rectangle of the canvas, in CSS pixels from its upper left corner. */
export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

const gap = 8; // px between the picture and the boxes

/**
 * Finds the rectangle of the canvas that no box covers and in which the picture is largest. `sizeIn` returns the size
 * of the picture in a free rectangle of a width and height (px). Returns the rectangle's distances from the edges.
 */
export function freePart(
  width: number,
  height: number,
  boxes: readonly Box[],
  sizeIn: (width: number, height: number) => number,
): Insets {
  const lefts = [gap, ...boxes.map((box) => box.right + gap)];
  const tops = [gap, ...boxes.map((box) => box.bottom + gap)];
  const rights = [width - gap, ...boxes.map((box) => box.left - gap)];
  const bottoms = [height - gap, ...boxes.map((box) => box.top - gap)];
  let best: Box = { left: 0, top: 0, right: width, bottom: height };
  let size = 0;
  for (const left of lefts) {
    for (const right of rights) {
      if (right <= left) continue;
      for (const top of tops) {
        for (const bottom of bottoms) {
          if (bottom <= top) continue;
          const candidate = { left, top, right, bottom };
          const own = sizeIn(right - left, bottom - top);
          if (own <= size || boxes.some((box) => overlap(box, candidate))) continue;
          best = candidate;
          size = own;
        }
      }
    }
  }
  return { top: best.top, right: width - best.right, bottom: height - best.bottom, left: best.left };
}

function overlap(a: Box, b: Box): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}
