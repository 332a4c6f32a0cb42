import type { Facts, Vec3 } from "./facts";

/** The half-space that images show: the points p with normal · p ≤ offset, relative to the centre of the bounds (m). */
export interface HalfSpace {
  normal: Vec3; // unit length, or zeros: all of space
  offset: number; // m
}

export const sides = ["none", "x", "y", "z"] as const;
export type Side = (typeof sides)[number];

export const everything: HalfSpace = { normal: [0, 0, 0], offset: 1 };

/** The parts of the scene that images leave out: groups of spheres, and all beyond a plane across an axis. */
export class Cut {
  readonly hidden = new Set<number>(); // numbers of groups
  side: Side = "none"; // the axis across which the plane lies
  share = 0.5; // of the bounds along the axis, from the low end
  flipped = false; // the high end is shown
  /** Grows with each change of `hidden`. */
  version = 0;
  private readonly kept: HalfSpace = { normal: [0, 0, 0], offset: 1 };

  /** The half-space that is shown; the next call changes it. */
  halfSpace({ min, max }: Facts): HalfSpace {
    if (this.side === "none") return everything;
    const { kept } = this;
    const axis = sides.indexOf(this.side) - 1;
    const sign = this.flipped ? -1 : 1;
    kept.normal.fill(0);
    kept.normal[axis] = sign;
    kept.offset = sign * (this.share - 0.5) * ((max[axis] as number) - (min[axis] as number));
    return kept;
  }

  show(group: number, shown: boolean): void {
    if (shown === !this.hidden.has(group)) return;
    if (shown) this.hidden.delete(group);
    else this.hidden.add(group);
    this.version += 1;
  }

  /** Shows one group alone, or all groups if it is already alone. `groups`: their number. */
  isolate(group: number, groups: number): void {
    const isAlone = !this.hidden.has(group) && this.hidden.size === groups - 1;
    for (let other = 0; other < groups; other++) this.show(other, isAlone || other === group);
  }

  /** Shows everything. */
  reset(): void {
    if (this.hidden.size > 0) this.version += 1;
    this.hidden.clear();
    this.side = "none";
    this.share = 0.5;
    this.flipped = false;
  }
}
