import type { Facts, Vec3 } from "./facts";
import { writePosition } from "./positions";
import type { Shown } from "./states";

export const capacity = 2048; // segments

/** The path of a sphere through the states that were shown. Positions are relative to the centre of the bounds (m). */
export class Trace {
  /** Begin and end of each segment, x y z. Segment k is at k mod capacity; the older ones are overwritten. */
  readonly segments = new Float32Array(6 * capacity);
  length = 0; // segments since the path began
  run = 0; // grows when another path begins
  readonly end: Vec3 = [0, 0, 0]; // where the sphere is drawn
  readonly last: Vec3 = [0, 0, 0]; // end of the last segment
  known = false; // `end` and `last` have values
  private id: number | undefined;
  private epoch = -1;
  private time = 0; // s, of `last`
  private readonly next: Vec3 = [0, 0, 0];

  /** Call for each image. `id`, `place`: of the sphere; undefined: there is no path. Allocates nothing. */
  update(facts: Facts | undefined, shown: Shown | undefined, id: number | undefined, place: number | undefined): void {
    if (!facts || !shown || id === undefined || place === undefined || place >= shown.to.count) return this.clear();
    const { from } = shown;
    if (id !== this.id || facts.epoch !== this.epoch || from.simTime < this.time) this.clear();
    writePosition(this.end, facts, shown, place, shown.mix);
    if (this.known && from.simTime === this.time) return;
    writePosition(this.next, facts, shown, place, 0);
    if (this.known && isNear(facts, this.last, this.next)) {
      const at = 6 * (this.length % capacity);
      this.segments.set(this.last, at);
      this.segments.set(this.next, at + 3);
      this.length += 1;
    }
    copy(this.last, this.next);
    this.id = id;
    this.epoch = facts.epoch;
    this.time = from.simTime;
    this.known = true;
  }

  private clear(): void {
    if (!this.known) return;
    this.known = false;
    this.id = undefined;
    this.length = 0;
    this.run += 1;
  }
}

/** False if the sphere has crossed a face of a periodic axis in between. */
function isNear({ periods }: Facts, a: Vec3, b: Vec3): boolean {
  for (let axis = 0; axis < 3; axis++) {
    const period = periods[axis] as number;
    if (period > 0 && Math.abs((b[axis] as number) - (a[axis] as number)) > 0.5 * period) return false;
  }
  return true;
}

function copy(to: Vec3, from: Vec3): void {
  for (let axis = 0; axis < 3; axis++) to[axis] = from[axis] as number;
}
