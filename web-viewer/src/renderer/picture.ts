import { viewOfPart } from "../camera/view";
import type { View } from "../camera/view";

export const largestSide = 16_384; // px, of a picture
const side = 2048; // px, of a tile, with its margin
const margin = 64; // px: what a tile needs around it for ambient occlusion and smooth edges

interface Span {
  begin: number; // px of the picture
  end: number;
  from: number; // px of the picture where the tile begins, with its margin
  to: number;
}

/** The tiles along one axis. */
export function spansOf(length: number): Span[] {
  const step = length <= side ? length : side - 2 * margin;
  const spans: Span[] = [];
  for (let begin = 0; begin < length; begin += step) {
    const end = Math.min(length, begin + step);
    spans.push({ begin, end, from: Math.max(0, begin - margin), to: Math.min(length, end + margin) });
  }
  return spans;
}

/**
 * Draws a picture of any size up to `largestSide`, tile by tile, so that the device needs little memory. `draw` draws a
 * view in a number of pixels. `progress` is given the share that is done; the work ends, and
 * the result is undefined, when it returns false. Throws an Error if the browser has too little memory.
 */
export async function pictureOf(
  view: View,
  width: number,
  height: number,
  draw: (view: View, width: number, height: number) => ImageData,
  progress: (share: number) => boolean,
): Promise<Blob | undefined> {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const picture = canvas.getContext("2d");
  if (!picture) throw new Error("The browser has too little memory for a picture of this size.");
  const [columns, rows] = [spansOf(width), spansOf(height)];
  let done = 0;
  for (const row of rows) {
    for (const column of columns) {
      const [tileWidth, tileHeight] = [column.to - column.from, row.to - row.from];
      const part = {
        x: column.from / width,
        y: 1 - row.to / height,
        width: tileWidth / width,
        height: tileHeight / height,
      };
      const tile = draw(viewOfPart(view, part), tileWidth, tileHeight);
      const [x, y] = [column.begin - column.from, row.begin - row.from];
      picture.putImageData(tile, column.from, row.from, x, y, column.end - column.begin, row.end - row.begin);
      done += 1;
      if (!progress(done / (rows.length * columns.length))) return undefined;
      await new Promise(requestAnimationFrame); // the page stays alive
    }
  }
  return new Promise((resolve, reject) => {
    const made = (file: Blob | null): void => {
      if (file) resolve(file);
      else reject(new Error("The browser has too little memory for a picture of this size."));
    };
    canvas.toBlob(made, "image/png");
  });
}
