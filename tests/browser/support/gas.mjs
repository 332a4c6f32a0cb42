// A scene that never comes to rest, and a log of its states on a page.
import { writeFile } from "node:fs/promises";
import path from "node:path";

/**
 * Writes a scene of a few spheres that fly and bounce for ever, along a periodic axis. Returns its path. `more`:
 * further fields of the scene.
 */
export async function gasScene(folder, name = "gas", more = {}) {
  const spheres = [];
  for (let k = 0; k < 24; k++) {
    const position = [0.25 + 0.5 * (k % 4), 0.25 + 0.25 * (Math.floor(k / 4) % 3), k < 12 ? 0.3 : 0.7];
    spheres.push({ position, velocity: [1 - 0.3 * (k % 5), 0.2 * (k % 3), 0.15 * (k % 7) - 0.4] });
  }
  const scene = {
    name,
    gravity: [0, 0, 0],
    bounds: { min: [0, 0, 0], max: [2, 1, 1], periodic: ["X"] },
    materials: [{ restitution: 1 }],
    groups: [{ name: "gas", radius: { constant: 0.08 }, list: { spheres } }],
    ...more,
  };
  const file = path.join(folder, `${name}.json`);
  await writeFile(file, JSON.stringify(scene));
  return file;
}

/** Logs all positions of each state that the page receives live, by simulated time: `window.seen`. */
export function logStates(page) {
  return page.evaluate(() => {
    window.seen = new Map();
    const { session } = spherule;
    const handle = session.handle.bind(session);
    session.handle = (message) => {
      handle(message);
      if (message.kind !== "frame" || session.replay || session.newest?.simTime !== message.frame.simTime) return;
      window.seen.set(message.frame.simTime, spherule.positions([...Array(spherule.spheres).keys()]).positions);
    };
  });
}
