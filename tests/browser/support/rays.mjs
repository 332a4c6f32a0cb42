// Which sphere each pixel of an image shows, computed in double precision from the scene and the camera.

/** The inverse of a 4 x 4 matrix, column after column. */
function inverse(m) {
  const axes = [0, 1, 2, 3];
  const rows = axes.map((r) => [...axes.map((c) => m[4 * c + r]), ...axes.map((c) => (r === c ? 1 : 0))]);
  for (const k of axes) {
    const [best] = axes.slice(k).sort((a, b) => Math.abs(rows[b][k]) - Math.abs(rows[a][k]));
    [rows[k], rows[best]] = [rows[best], rows[k]];
    rows[k] = rows[k].map((value) => value / rows[k][k]);
    rows.forEach((row, r) => {
      if (r !== k) rows[r] = row.map((value, c) => value - row[k] * rows[k][c]);
    });
  }
  return axes.flatMap((c) => rows.map((row) => row[4 + c]));
}

/** A point in clip space (x, y, z), relative to the eye. */
function unprojected(fromClip, x, y, z) {
  const [a, b, c, w] = [0, 1, 2, 3].map(
    (r) => fromClip[r] * x + fromClip[4 + r] * y + fromClip[8 + r] * z + fromClip[12 + r],
  );
  return [a / w, b / w, c / w];
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

/**
 * Returns a function of a point of the image, in pixels from its upper left corner: the ray there. Its origin is on the
 * near plane, relative to the eye (m); its direction is of unit length.
 */
export function rays({ toClip }, width, height) {
  const fromClip = inverse(toClip);
  return (column, row) => {
    const [x, y] = [(2 * column) / width - 1, 1 - (2 * row) / height];
    const near = unprojected(fromClip, x, y, -1);
    const along = minus(unprojected(fromClip, x, y, 0), near);
    const length = Math.hypot(...along);
    return { near, direction: along.map((part) => part / length) };
  };
}

/**
 * Returns a function of a point of the image, in pixels from its upper left corner: the place of the nearest sphere
 * there; -1: none. Its property `centreOf` returns the point where a sphere's centre is. `kept`: the points p with
 * normal · p ≤ offset (m) are shown; absent: all.
 */
export function placesSeen(camera, spheres, width, height, kept = { normal: [0, 0, 0], offset: 0 }) {
  const { eye, toClip } = camera;
  const keptOffset = kept.offset - dot(kept.normal, eye); // relative to the eye
  const rayAt = rays(camera, width, height);
  const seen = spheres.map(({ position, radius }) => ({ to: minus(position, eye), square: radius * radius }));
  const centreOf = (place) => {
    const { to } = seen[place];
    const [x, y, , w] = [0, 1, 2, 3].map(
      (r) => toClip[r] * to[0] + toClip[4 + r] * to[1] + toClip[8 + r] * to[2] + toClip[12 + r],
    );
    return [(0.5 + (0.5 * x) / w) * width, (0.5 - (0.5 * y) / w) * height];
  };
  const placeAt = (column, row) => {
    const { near, direction } = rayAt(column, row);
    const steep = dot(kept.normal, direction);
    const room = keptOffset - dot(kept.normal, near);
    const begin = steep < 0 ? room / steep : -Infinity; // of the part of the ray that is shown
    const end = steep > 0 ? room / steep : steep === 0 && room < 0 ? -Infinity : Infinity;
    let [found, nearest] = [-1, Infinity];
    for (let place = 0; place < seen.length; place++) {
      const { to, square } = seen[place];
      const [x0, y0, z0] = [to[0] - near[0], to[1] - near[1], to[2] - near[2]];
      const middle = x0 * direction[0] + y0 * direction[1] + z0 * direction[2];
      const depth2 = square - (x0 * x0 + y0 * y0 + z0 * z0 - middle * middle);
      if (depth2 < 0) continue;
      const surface = Math.max(middle - Math.sqrt(depth2), begin);
      if (surface > 0 && surface <= Math.min(middle + Math.sqrt(depth2), end) && surface < nearest) {
        [found, nearest] = [place, surface];
      }
    }
    return found;
  };
  return Object.assign(placeAt, { centreOf });
}

const offsets = [-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1]; // px

/**
 * Compares places that are drawn with those expected by placesSeen(). `differ`: pixels with another place than in their
 * middle; `wrong`: those whose place is not expected anywhere within one pixel of their middle. A sphere may be smaller
 * than the distance of the points that are tried there: then its centre counts.
 */
export function compare({ width, places }, expected) {
  const wrong = [];
  let differ = 0;
  places.forEach((place, k) => {
    const [column, row] = [(k % width) + 0.5, Math.floor(k / width) + 0.5];
    if (expected(column, row) === place) return;
    differ += 1;
    const isNear = offsets.some((dy) => offsets.some((dx) => expected(column + dx, row + dy) === place));
    const [x, y] = place < 0 ? [NaN, NaN] : expected.centreOf(place);
    if (!isNear && !(Math.max(Math.abs(x - column), Math.abs(y - row)) <= 1)) wrong.push({ column, row, place });
  });
  return { differ, wrong };
}

/** Spheres in a cube with sides of 2, which do not overlap. */
export function cluster({ least, ratio, count }) {
  let state = 12345;
  const random = () => (state = (state * 48271) % 0x7fffffff) / 0x7fffffff;
  const spheres = [];
  while (spheres.length < count) {
    const radius = least * ratio ** random();
    const position = [0, 1, 2].map(() => (1 - radius) * (2 * random() - 1));
    const isFree = spheres.every((other) => {
      return Math.hypot(...position.map((x, k) => x - other.position[k])) > radius + other.radius;
    });
    if (isFree) spheres.push({ position, radius });
  }
  return spheres;
}
