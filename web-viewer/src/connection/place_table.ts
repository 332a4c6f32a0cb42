import type { GroupFacts, Places, Population, SceneFacts } from "../gen/spherule/v1/facts_pb";

const unused = -1;

/** Follows which sphere is at each place of frames, and so knows the facts of a scene at any moment. */
export class PlaceTable {
  number: number; // of the last change that the table includes
  private ids: Float64Array | undefined; // per place; undefined: no change has come yet
  private groupOf = new Uint32Array(0); // number of the group, per place
  private radii = new Float32Array(0); // m, per place; empty if all radii are equal
  private groups: GroupFacts[];

  constructor(private readonly scene: SceneFacts) {
    this.number = scene.population;
    this.groups = scene.groups;
  }

  apply({ number, removed, added, groups }: Population): void {
    const ids = this.tabulated();
    for (const { first, count } of removed) ids.fill(unused, first, first + count);
    this.groups = [...this.groups, ...groups];
    for (const run of added) this.occupy(ids, run);
    this.number = number;
  }

  /** The facts of the scene with the present population. */
  facts(): SceneFacts {
    if (!this.ids) return this.scene;
    const radii = new Uint8Array(this.radii.slice().buffer);
    return { ...this.scene, groups: this.groups, places: this.runs(this.ids), radii, population: this.number };
  }

  private tabulated(): Float64Array {
    if (this.ids) return this.ids;
    const { count, places, groups, radius, radii } = this.scene;
    this.ids = new Float64Array(count).fill(unused);
    this.groupOf = new Uint32Array(count);
    if (!(radius > 0)) this.radii = floats(radii, count);
    if (places.length > 0) {
      for (const run of places) this.occupy(this.ids, { ...run, radii: new Uint8Array(0) });
    } else {
      for (let place = 0; place < count; place++) this.ids[place] = place;
      groups.forEach((group, k) => this.groupOf.fill(k, group.first, group.first + group.count));
    }
    return this.ids;
  }

  /** Puts spheres at places. Without `radii` of the run, the radii of the places stay. */
  private occupy(ids: Float64Array, { first, count, id, group, radii }: Places): void {
    const end = Math.min(first + count, ids.length);
    for (let place = first; place < end; place++) ids[place] = Number(id) + place - first;
    this.groupOf.fill(group, first, end);
    if (this.radii.length > 0 && radii.length > 0) this.radii.set(floats(radii, end - first), first);
  }

  /** The places in use, in runs of consecutive places and ids of one group. */
  private runs(ids: Float64Array): Places[] {
    const runs: Places[] = [];
    ids.forEach((id, place) => {
      if (id < 0) return;
      const group = this.groupOf[place] as number;
      const last = runs.at(-1);
      const ahead = last && last.first + last.count === place && last.group === group;
      if (ahead && Number(last.id) + last.count === id) last.count += 1;
      else runs.push({ ...emptyRun, first: place, count: 1, id: BigInt(id), group });
    });
    return runs.length > 0 ? runs : [emptyRun];
  }
}

/** Also tells that no place is in use. */
const emptyRun: Places = {
  $typeName: "spherule.v1.Places",
  first: 0,
  count: 0,
  id: 0n,
  group: 0,
  radii: new Uint8Array(0),
};

/** `bytes`: float32 little endian. Missing values are 0. */
function floats(bytes: Uint8Array, count: number): Float32Array<ArrayBuffer> {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const known = Math.min(count, Math.floor(bytes.byteLength / 4));
  return Float32Array.from({ length: count }, (_, k) => (k < known ? view.getFloat32(4 * k, true) : 0));
}
