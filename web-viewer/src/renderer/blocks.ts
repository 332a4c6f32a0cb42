import type { View } from "../camera/view";
import { blockPlaces } from "../columns";
import type { HalfSpace } from "../model/cut";
import type { Facts, Vec3 } from "../model/facts";
import type { DrawOrder, Shown, State } from "../model/states";
import type { DrawState } from "./draw_state";

/** How spheres are drawn, by their size in the image. */
export const enum Detail {
  Point, // smaller than a pixel
  Disc, // so small that the depth of a disc suffices
  Round,
}

/** Consecutive spheres in the order of drawing that are drawn alike. */
export interface DrawRun {
  first: number;
  count: number;
  detail: Detail;
}

const largestPoint = 0.5; // px, radius
const largestDisc = 12; // px, radius

/**
 * Blocks of spheres that are neighbours in the order of drawing: finds those in the view, and how large they are in the
 * image. Allocates nothing per image.
 */
export class SphereBlocks {
  /** The runs to draw, `length` of them. */
  readonly runs: DrawRun[] = [];
  length = 0;
  private facts: Facts | undefined;
  private order: DrawOrder | undefined;
  private radii = new Float32Array(0); // m, the largest of each block
  private boxes = new Float64Array(0); // m, low and high corner of each block in the states shown
  private from: State | undefined;
  private to: State | undefined;
  private known = false; // the boxes belong to the states shown
  private readonly planes = new Float64Array(4 * 6);

  /** `order`: of the epoch; undefined while it is not known. Call again when the population has changed. */
  set(facts: Facts, order: DrawOrder | undefined): void {
    this.facts = facts;
    this.order = order;
    this.from = this.to = undefined;
    const { population } = facts;
    const blocks = Math.ceil(population.places / blockPlaces);
    if (this.radii.length !== blocks) this.radii = new Float32Array(blocks);
    if (this.boxes.length !== 6 * blocks) this.boxes = new Float64Array(6 * blocks);
    this.radii.fill(population.radius);
    if (!order || !population.radii) return;
    for (let k = 0; k < order.places.length; k++) {
      const block = Math.floor(k / blockPlaces);
      const radius = population.radii[order.places[k] as number] ?? 0;
      if (radius > (this.radii[block] as number)) this.radii[block] = radius;
    }
  }

  /**
   * Finds the runs of `count` spheres in a view. `eye`: relative to the centre of the bounds (m); `pixel`: height of a
   * pixel (m) at a distance of 1 m, or at all distances if the view is orthographic.
   */
  find(shown: Shown, count: number, { view, kept }: DrawState, eye: Vec3, pixel: number): void {
    this.length = 0;
    if (count === 0) return;
    this.takeBoxes(shown);
    if (!this.known) {
      this.add(0, count, Detail.Round);
      return;
    }
    this.takePlanes(view);
    for (let block = 0; block * blockPlaces < count; block++) {
      const side = this.sideOf(block, kept);
      if (side === "beyond") continue;
      let detail = this.detailOf(block, view, eye, pixel);
      if (detail === undefined) continue;
      if (side === "both" && detail === Detail.Disc) detail = Detail.Round;
      const first = block * blockPlaces;
      this.add(first, Math.min(blockPlaces, count - first), detail);
    }
  }

  private add(first: number, count: number, detail: Detail): void {
    const last = this.runs[this.length - 1];
    if (this.length > 0 && last?.detail === detail && last.first + last.count === first) {
      last.count += count;
      return;
    }
    const run = (this.runs[this.length] ??= { first, count, detail });
    this.length += 1;
    run.first = first;
    run.count = count;
    run.detail = detail;
  }

  /** Joins the boxes of both states: spheres are drawn between them. */
  private takeBoxes({ from, to }: Shown): void {
    if (from === this.from && to === this.to) return;
    this.from = from;
    this.to = to;
    const { boxes, order } = this;
    this.known = from.order === order?.number && to.order === order.number && from.boxes.length === boxes.length;
    if (!this.known) return;
    for (let at = 0; at < boxes.length; at += 6) {
      for (let k = at; k < at + 3; k++) {
        boxes[k] = Math.min(from.boxes[k] as number, to.boxes[k] as number);
        boxes[k + 3] = Math.max(from.boxes[k + 3] as number, to.boxes[k + 3] as number);
      }
    }
  }

  /** The planes of the view relative to the eye: normals of unit length, which point inwards, and distances. */
  private takePlanes({ toClip }: View): void {
    for (let plane = 0; plane < 6; plane++) {
      const axis = plane >> 1;
      const sign = plane & 1 ? -1 : 1;
      let length = 0;
      for (let k = 0; k < 4; k++) {
        const part = (toClip[4 * k + 3] as number) + sign * (toClip[4 * k + axis] as number);
        this.planes[4 * plane + k] = part;
        if (k < 3) length += part * part;
      }
      const scale = 1 / Math.sqrt(length || 1);
      for (let k = 0; k < 4; k++) this.planes[4 * plane + k] = (this.planes[4 * plane + k] as number) * scale;
    }
  }

  /** Where the spheres of a block are: in the half-space, beyond it, or possibly on both sides. */
  private sideOf(block: number, { normal, offset }: HalfSpace): "within" | "beyond" | "both" {
    const radius = this.radii[block] as number;
    let [least, most] = [-radius, radius];
    for (let axis = 0; axis < 3; axis++) {
      const along = normal[axis] as number;
      if (along === 0) continue; // the box may be infinite
      const low = along * (this.boxes[6 * block + axis] as number);
      const high = along * (this.boxes[6 * block + 3 + axis] as number);
      least += Math.min(low, high);
      most += Math.max(low, high);
    }
    return most <= offset ? "within" : least > offset ? "beyond" : "both";
  }

  /** Undefined: the block is outside of the view. */
  private detailOf(block: number, view: View, eye: Vec3, pixel: number): Detail | undefined {
    const { boxes, planes, facts } = this;
    const radius = this.radii[block] as number;
    if (radius <= 0 || !facts) return undefined;
    let near2 = 0;
    for (let axis = 0; axis < 3; axis++) {
      const gap = Math.max(
        (boxes[6 * block + axis] as number) - (eye[axis] as number),
        (eye[axis] as number) - (boxes[6 * block + 3 + axis] as number),
        0,
      );
      near2 += gap * gap;
    }
    for (let plane = 0; plane < 6; plane++) {
      let reach = (planes[4 * plane + 3] as number) + radius;
      for (let axis = 0; axis < 3; axis++) {
        const normal = planes[4 * plane + axis] as number;
        const corner = boxes[6 * block + axis + (normal > 0 ? 3 : 0)] as number; // the one that is farthest inside
        if (normal !== 0) reach += normal * (corner - (eye[axis] as number));
      }
      if (reach < 0) return undefined;
    }
    const pixels = radius / (view.orthographic ? pixel : pixel * Math.max(1e-9, Math.sqrt(near2) - radius));
    return pixels <= largestPoint ? Detail.Point : pixels <= largestDisc ? Detail.Disc : Detail.Round;
  }
}
