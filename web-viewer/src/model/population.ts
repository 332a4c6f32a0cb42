import { groupColour, materialColour } from "../colour/palette";
import type { Rgb } from "../colour/rgb";
import type { GroupFacts, Places, Population as Change, SceneFacts } from "../gen/spherule/v1/facts_pb";

/** Spheres come and go: which places of a frame hold a sphere, and which sphere that is. */

/** Consecutive places. */
export interface Run {
  first: number;
  count: number;
}

export interface Group {
  name: string;
  count: number; // spheres at present
  colour: Rgb;
  own: boolean; // the colour is given by the scene
  material: number | undefined; // its number in the scene; undefined: the server does not tell it
  fixed: boolean; // nothing moves its spheres
  roughness: number; // of the surface, 0..1
  metal: number; // 0..1
}

/** A material of spheres. */
export interface Material {
  name: string;
  count: number; // spheres at present
  colour: Rgb;
}

const unused = -1; // id at a place without a sphere
const noGroup = 0xffffffff; // as in renderer/shaders/colour.glsl

/** The spheres at the places of frames: id, radius and group of each. Places beyond the last one are ignored. */
export class Population {
  readonly places: number;
  number: number; // of the last change that the tables include
  count = 0; // places in use
  readonly groups: Group[];
  private readonly materialNames: readonly string[]; // of all materials of the scene
  readonly radius: number; // m, of every sphere; 0 if they differ

  /** Radius at each place (m), 0 if it is not in use. Undefined: all places are in use and all radii are equal. */
  radii: Float32Array | undefined;

  /** Id at each place, negative if it is not in use; exact below 2^53. Undefined: ids are the numbers of places. */
  ids: Float64Array | undefined;

  /** The index of the group at each place; noGroup if there is none. */
  readonly groupNumbers: Uint32Array;
  private readonly radiusExtent = new Extent();
  private readonly idExtent = new Extent();

  constructor(scene: SceneFacts) {
    this.places = scene.count;
    this.number = scene.population;
    this.radius = scene.radius;
    this.materialNames = scene.materials;
    const radii = scene.radius > 0 ? undefined : floats(scene.radii, scene.count);
    this.groupNumbers = new Uint32Array(scene.count).fill(noGroup);
    if (scene.places.length > 0) {
      this.groups = scene.groups.map((group, k) => groupFrom(group, k, 0));
      this.radii = new Float32Array(scene.count);
      this.ids = new Float64Array(scene.count).fill(unused);
      for (const run of scene.places) this.occupy(run, radii?.subarray(run.first));
    } else {
      this.groups = scene.groups.map((group, k) => groupFrom(group, k, group.count));
      this.count = scene.count;
      this.radii = radii;
      scene.groups.forEach(({ first, count }, k) => this.groupNumbers.fill(k, first, first + count));
    }
  }

  isUsed(place: number): boolean {
    return this.idOf(place) !== undefined;
  }

  /** Undefined if the place is not in use. */
  idOf(place: number): number | undefined {
    if (place >= this.places) return undefined;
    const id = this.ids ? (this.ids[place] as number) : place;
    return id >= 0 ? id : undefined;
  }

  /** Undefined if there is no such sphere. */
  placeOf(id: number): number | undefined {
    const place = this.ids ? this.ids.indexOf(id) : id;
    return place >= 0 && place < this.places ? place : undefined;
  }

  /** Radius (m); 0 if the place is not in use. */
  radiusOf(place: number): number {
    return this.radii ? (this.radii[place] ?? 0) : this.radius;
  }

  groupOf(place: number): Group | undefined {
    return this.groups[this.groupNumbers[place] ?? noGroup];
  }

  /** The materials of all groups that the server tells, in the order of the scene. */
  get materials(): Material[] {
    const counts = new Map<number, number>();
    for (const { material, count } of this.groups) {
      if (material !== undefined) counts.set(material, (counts.get(material) ?? 0) + count);
    }
    return [...counts]
      .sort(([one], [other]) => one - other)
      .map(([number, count]) => {
        const name = this.materialNames[number] || `material ${number + 1}`;
        return { name, count, colour: materialColour(number) };
      });
  }

  /** The smallest and the largest radius (m); zeros if there are no spheres. */
  get radiusRange(): [number, number] {
    if (this.radius > 0) return [this.radius, this.radius];
    return this.radiusExtent.of(this.radii ?? [], Number.MIN_VALUE);
  }

  /** The mean radius of the spheres that can move, or of all if none can (m); 0 if there are no spheres. */
  get meanRadius(): number {
    if (this.radius > 0) return this.radius;
    const sums = { moving: { sum: 0, count: 0 }, fixed: { sum: 0, count: 0 } };
    for (let place = 0; place < this.places; place++) {
      const radius = this.radiusOf(place);
      if (radius <= 0) continue;
      const one = this.groupOf(place)?.fixed ? sums.fixed : sums.moving;
      one.sum += radius;
      one.count += 1;
    }
    const { sum, count } = sums.moving.count > 0 ? sums.moving : sums.fixed;
    return count > 0 ? sum / count : 0;
  }

  /** The smallest and the largest id; zeros if there are no spheres. */
  get idRange(): [number, number] {
    return this.ids ? this.idExtent.of(this.ids, 0) : [0, Math.max(0, this.places - 1)];
  }

  /** Returns the places whose sphere has changed. */
  apply({ number, removed, added, groups }: Change): Run[] {
    this.tabulate();
    for (const run of removed) this.vacate(run);
    for (const group of groups) this.groups.push(groupFrom(group, this.groups.length, 0));
    for (const run of added) this.occupy(run, this.radius > 0 ? undefined : floats(run.radii, this.within(run).count));
    this.number = number;
    return [...removed, ...added].map((run) => this.within(run)).filter(({ count }) => count > 0);
  }

  private within({ first, count }: Run): Run {
    return { first, count: Math.max(0, Math.min(count, this.places - first)) };
  }

  /** Makes the tables of a scene whose places are all in use. */
  private tabulate(): void {
    this.radii ??= new Float32Array(this.places).fill(this.radius);
    this.ids ??= new Float64Array(this.places).map((_, place) => place);
  }

  /** Puts spheres at places. `radii`: of these spheres (m); undefined if all radii are equal. */
  private occupy(run: Places, radii: Float32Array | undefined): void {
    this.vacate(run);
    const { first, count } = this.within(run);
    for (let k = 0; k < count; k++) {
      const place = first + k;
      const radius = radii ? (radii[k] ?? 0) : this.radius;
      const id = Number(run.id) + k;
      (this.ids as Float64Array)[place] = id;
      (this.radii as Float32Array)[place] = radius;
      this.groupNumbers[place] = run.group;
      this.idExtent.add(id);
      this.radiusExtent.add(radius);
    }
    this.count += count;
    const group = this.groups[run.group];
    if (group) group.count += count;
  }

  /** Takes the spheres away from places. */
  private vacate(run: Run): void {
    const { first, count } = this.within(run);
    for (let place = first; place < first + count; place++) {
      const id = this.idOf(place);
      if (id === undefined) continue;
      this.idExtent.remove(id);
      this.radiusExtent.remove(this.radiusOf(place));
      const group = this.groupOf(place);
      if (group) group.count -= 1;
      (this.ids as Float64Array)[place] = unused;
      (this.radii as Float32Array)[place] = 0;
      this.groupNumbers[place] = noGroup;
      this.count -= 1;
    }
  }
}

/** The smallest and the largest of values that come and go. */
class Extent {
  private low = Infinity;
  private high = -Infinity;
  private known = false;

  add(value: number): void {
    this.low = Math.min(this.low, value);
    this.high = Math.max(this.high, value);
  }

  remove(value: number): void {
    if (value <= this.low || value >= this.high) this.known = false;
  }

  /** The extent of the present values; values below `least` do not count. Zeros if there are none. */
  of(values: ArrayLike<number>, least: number): [number, number] {
    if (!this.known) this.measure(values, least);
    return this.low <= this.high ? [this.low, this.high] : [0, 0];
  }

  private measure(values: ArrayLike<number>, least: number): void {
    this.low = Infinity;
    this.high = -Infinity;
    for (let k = 0; k < values.length; k++) {
      const value = values[k] as number;
      if (value >= least) this.add(value);
    }
    this.known = true;
  }
}

/** Changes that no received frame includes yet, by their numbers. */
export class PendingChanges {
  private list: { number: number; apply(): Run[] }[] = [];

  /** `newest`: number of the last known change. */
  constructor(public newest: number) {}

  /** Ignores a known change. Throws an Error if the change before is missing. */
  add(number: number, apply: () => Run[]): void {
    if (number <= this.newest) return;
    if (number !== this.newest + 1) {
      throw new Error(`population: change ${number} does not follow change ${this.newest}`);
    }
    this.newest = number;
    this.list.push({ number, apply });
  }

  /** Replaces all changes up to `number` by one that includes them; without one, forgets them. */
  replace(number: number, apply?: () => Run[]): void {
    const later = this.list.filter((change) => change.number > number);
    this.list = apply ? [{ number, apply }, ...later] : later;
    this.newest = Math.max(this.newest, number);
  }

  /**
   * Applies the changes up to `number`. Returns the places whose sphere has changed; undefined if there was no change.
   */
  applyTo(number: number): Run[] | undefined {
    const later = this.list.findIndex((change) => change.number > number);
    const due = this.list.splice(0, later < 0 ? this.list.length : later);
    return due.length > 0 ? due.flatMap(({ apply }) => apply()) : undefined;
  }
}

/** The places that hold another sphere, or one only before or after. */
export function differences(before: Population, after: Population): Run[] {
  const runs: Run[] = [];
  for (let place = 0; place < after.places; place++) {
    if (before.idOf(place) === after.idOf(place)) continue;
    const last = runs.at(-1);
    if (last && last.first + last.count === place) last.count += 1;
    else runs.push({ first: place, count: 1 });
  }
  return runs;
}

/** Joins runs that are at most `gap` places apart to fewer runs, which include the places in between. */
export function joined(runs: readonly Run[], gap: number): Run[] {
  const spans: Run[] = [];
  for (const { first, count } of [...runs].sort((a, b) => a.first - b.first)) {
    const last = spans.at(-1);
    if (last && first <= last.first + last.count + gap) last.count = Math.max(last.count, first + count - last.first);
    else spans.push({ first, count });
  }
  return spans;
}

function groupFrom(group: GroupFacts, index: number, count: number): Group {
  const { name, material, fixed, roughness = 0.45, metal } = group;
  const { colour, own } = groupColour(group.colour, index);
  return { name: name || `group ${index + 1}`, count, colour, own, material, fixed, roughness, metal };
}

/** `bytes`: float32 little endian. Missing values are 0. */
function floats(bytes: Uint8Array, count: number): Float32Array {
  const values = new Float32Array(count);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (let i = 0; i < count && 4 * i + 4 <= bytes.byteLength; i++) values[i] = view.getFloat32(4 * i, true);
  return values;
}
