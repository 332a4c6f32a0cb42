import { observed } from "../observed";
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
  @observed accessor hidden: ReadonlySet<number> = new Set(); // numbers of groups; another set after each change
  @observed accessor side: Side = "none"; // the axis across which the plane lies
  @observed accessor share = 0.5; // of the bounds along the axis, from the low end
  @observed accessor flipped = false; // the high end is shown
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
    const hidden = new Set(this.hidden);
    if (shown) hidden.delete(group);
    else hidden.add(group);
    this.hidden = hidden;
  }

  /** Shows one group alone, or all groups if it is already alone. `groups`: their number. */
  isolate(group: number, groups: number): void {
    const others = Array.from({ length: groups }, (_, other) => other).filter((other) => other !== group);
    const isAlone = !this.hidden.has(group) && this.hidden.size === others.length;
    this.hidden = new Set(isAlone ? [] : others);
  }

  /** Shows everything. */
  reset(): void {
    if (this.hidden.size > 0) this.hidden = new Set();
    this.side = "none";
    this.share = 0.5;
    this.flipped = false;
  }
}
