import { bufferOf, columnFormats, columnNames } from "../columns";
import type { ColumnName } from "../columns";
import { materialColour } from "../colour/palette";
import type { Facts, Vec3 } from "../model/facts";
import { capacity } from "../model/playout";
import { joined } from "../model/population";
import type { Population, Run } from "../model/population";
import type { DrawOrder, Shown, State } from "../model/states";
import { Grids } from "./grids";
import { bindTexture } from "./program";
import type { Program, Sampler } from "./program";
import { Table } from "./table";

/** A state on the device. */
interface Resident {
  tables: Map<ColumnName, Table>;
  state: State | undefined;
  used: number; // value of `turn` at its last use
}

const texelsPerLook = 3;
const fromSamplers = new Map(columnNames.map((name): [ColumnName, Sampler] => [name, `u_${name}From`]));
const toSamplers = new Map(columnNames.map((name): [ColumnName, Sampler] => [name, `u_${name}To`]));

/**
 * The spheres' data on the device, in tables by place: states as received, and radius, id and group, which change with
 * the population. Shaders read them with shaders/spheres.glsl.
 */
export class SphereData {
  count = 0; // places
  private readonly residents: Resident[];
  private readonly radii: Table;
  private readonly ids: Table;
  private readonly groups: Table; // number of the group at each place
  private readonly looks: Table; // colour and surface of each group
  private readonly order: Table;
  private readonly nothing: Table;
  private facts: Facts | undefined;
  private images: Image[] = [];
  private readonly grids = new Grids();
  private readonly periods = new Float32Array(3); // m
  private readonly perLength = new Float32Array(3); // 1/m
  private readonly faces = new Float32Array(6); // m, relative to the eye
  private tabled = false; // the tables hold ids, and radii even if all are equal
  private hidden: ReadonlySet<number> = new Set(); // numbers of groups
  private shownRadii = new Float32Array(0); // m; 0 for hidden spheres; used if a group is hidden
  private idValues = new Float32Array(0); // ids as the device holds them
  private turn = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.residents = Array.from({ length: capacity }, () => ({ tables: new Map(), state: undefined, used: 0 }));
    this.radii = new Table(gl, 1);
    this.ids = new Table(gl, 1);
    this.groups = new Table(gl, 1, true);
    this.looks = new Table(gl, 4);
    this.order = new Table(gl, 1, true);
    this.nothing = new Table(gl, 1);
  }

  setFacts(facts: Facts): void {
    const { population, periods } = facts;
    this.facts = facts;
    this.images = imagesOf(facts);
    this.periods.set(periods);
    this.perLength.set(periods.map((length) => (length > 0 ? 1 / length : 0)));
    this.tabled = population.ids !== undefined;
    for (const table of [this.radii, this.ids, this.groups]) table.fit(population.places);
    this.uploadTables(population, { first: 0, count: population.places });
    this.uploadLooks(population);
  }

  /** Leaves out groups of these numbers. Their spheres have the radius 0 on the device. */
  hide(hidden: ReadonlySet<number>): void {
    this.hidden = hidden;
    const { population } = this.facts ?? {};
    if (population) this.uploadTables(population, { first: 0, count: population.places });
  }

  /** Uploads what has changed in the population. `changed`: the places whose sphere has changed. */
  updatePopulation(changed: readonly Run[]): void {
    const { facts } = this;
    if (!facts) return;
    const { population } = facts;
    const spans = joined(changed, Math.max(64, population.places >> 8)); // few uploads
    if (this.tabled) for (const span of spans) this.uploadTables(population, span);
    else this.setFacts(facts);
    this.uploadLooks(population);
    for (const { tables, state } of this.residents) {
      // The buffer of a state that is not needed any more has returned to the worker.
      if (!state || bufferOf(state.columns).byteLength === 0) continue;
      for (const [name, table] of tables) {
        const values = state.columns[name]?.values;
        if (values) for (const span of spans) table.upload(values, span);
      }
    }
  }

  /** The order of drawing; undefined: by place. */
  setOrder(order: DrawOrder | undefined): void {
    const places = order?.places ?? Uint32Array.from({ length: this.facts?.population.places ?? 0 }, (_, k) => k);
    this.order.fit(places.length);
    this.order.upload(places, { first: 0, count: places.length });
  }

  /** Selects the states to draw, and uploads those that are new. `eye`: relative to the centre of the bounds (m). */
  show(shown: Shown, eye: Vec3): void {
    this.count = Math.min(shown.from.count, shown.to.count, this.facts?.population.places ?? 0);
    const from = this.resident(shown.from);
    const to = this.resident(shown.to);
    // An upload binds its table, which may be of integers, in place of another: so no table is bound before.
    this.bindState(fromSamplers, from);
    this.bindState(toSamplers, to);
    this.grids.set(0, shown.from.columns.position, eye);
    this.grids.set(1, shown.to.columns.position, eye);
    // Runs for every image: an iterator would be new memory each time.
    for (let k = 0; k < 3; k++) {
      const axis = k as 0 | 1 | 2;
      const half = 0.5 * (this.facts?.periods[axis] || 1e30);
      this.faces[axis] = -half - eye[axis];
      this.faces[axis + 3] = half - eye[axis];
    }
    bindTexture(this.gl, "u_order", this.order.texture);
    bindTexture(this.gl, "u_radius", this.radii.texture);
    bindTexture(this.gl, "u_id", this.ids.texture);
    bindTexture(this.gl, "u_group", this.groups.texture);
    bindTexture(this.gl, "u_looks", this.looks.texture);
  }

  /** Sets the uniforms of shaders/spheres.glsl. `mix`: as in Shown. */
  prepare(program: Program, mix: number): void {
    const { gl, facts } = this;
    if (!facts) return;
    this.grids.fill(gl, program);
    gl.uniform1f(program.at("u_mix"), mix);
    const isSame = !this.tabled && this.hidden.size === 0;
    gl.uniform1f(program.at("u_sameRadius"), isSame ? facts.population.radius : 0);
    gl.uniform1i(program.at("u_idsGiven"), this.tabled ? 1 : 0);
    gl.uniform3fv(program.at("u_period"), this.periods);
    gl.uniform3fv(program.at("u_perLength"), this.perLength);
    gl.uniform3fv(program.at("u_faces"), this.faces);
  }

  /**
   * Draws spheres from `first` on in the order of drawing, with a prepared program: as squares, or as points. Spheres
   * that reach across a face of a periodic axis are drawn again at the other face, with one more call for each set of
   * axes.
   */
  draw(program: Program, first: number, count: number, points = false): void {
    const { gl } = this;
    if (count === 0) return;
    gl.uniform1i(program.at("u_first"), first);
    for (let k = 0; k < this.images.length; k++) {
      const image = this.images[k] as (typeof this.images)[number];
      gl.uniform3fv(program.at("u_image"), image.axes);
      gl.uniform1ui(program.at("u_imageBits"), image.bits);
      if (points) gl.drawArrays(gl.POINTS, 0, count);
      else gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    }
  }

  private bindState(samplers: ReadonlyMap<ColumnName, Sampler>, { tables, state }: Resident): void {
    samplers.forEach((sampler, name) => {
      const table = state?.columns[name] ? tables.get(name) : undefined;
      bindTexture(this.gl, sampler, (table ?? this.nothing).texture);
    });
  }

  private resident(state: State): Resident {
    this.turn += 1;
    let found: Resident | undefined;
    let oldest = this.residents[0] as Resident;
    for (let k = 0; k < this.residents.length; k++) {
      const resident = this.residents[k] as Resident;
      if (resident.state === state) found = resident;
      if (resident.used < oldest.used) oldest = resident;
    }
    if (!found) {
      found = oldest;
      found.state = state;
      for (const name of columnNames) {
        const values = state.columns[name]?.values;
        if (values) this.uploadColumn(found, name, values, state.count);
      }
    }
    found.used = this.turn;
    return found;
  }

  private uploadColumn({ tables }: Resident, name: ColumnName, values: Float32Array | Int32Array, count: number): void {
    let table = tables.get(name);
    if (!table) {
      const { components, whole } = columnFormats[name];
      table = new Table(this.gl, components === 1 ? 1 : 3, whole);
      tables.set(name, table);
    }
    table.fit(count);
    table.upload(values, { first: 0, count });
  }

  private uploadTables(population: Population, run: Run): void {
    const { ids, groupNumbers } = population;
    const radii = this.hidden.size > 0 ? this.withoutHidden(population, run) : population.radii;
    if (radii) this.radii.upload(radii, run);
    if (ids) {
      if (this.idValues.length !== ids.length) this.idValues = new Float32Array(ids.length);
      this.idValues.set(ids.subarray(run.first, run.first + run.count), run.first);
      this.ids.upload(this.idValues, run);
    }
    this.groups.upload(groupNumbers, run);
  }

  /** The radii (m) of a run of places, with 0 for hidden spheres. */
  private withoutHidden(population: Population, { first, count }: Run): Float32Array {
    if (this.shownRadii.length !== population.places) this.shownRadii = new Float32Array(population.places);
    for (let place = first; place < first + count; place++) {
      const isHidden = this.hidden.has(population.groupNumbers[place] as number);
      this.shownRadii[place] = isHidden ? 0 : population.radiusOf(place);
    }
    return this.shownRadii;
  }

  /** Three texels per group, as in shaders/colour.glsl. */
  private uploadLooks({ groups }: Population): void {
    const values = new Float32Array(4 * texelsPerLook * Math.max(1, groups.length));
    groups.forEach(({ colour, roughness, metal, fixed, material }, group) => {
      const texels = [...colour, roughness, metal, Number(fixed), 0, 0, ...materialColour(material)];
      values.set(texels, 4 * texelsPerLook * group);
    });
    this.looks.fit(values.length / 4);
    this.looks.upload(values, { first: 0, count: values.length / 4 });
  }
}

/** A set of periodic axes across whose faces images are drawn: 1 per axis in the set, and the same as bits. */
interface Image {
  axes: Float32Array;
  bits: number; // as in the codes of shaders/code.glsl
}

/** All sets of periodic axes. The first one is empty. */
function imagesOf({ periods }: Facts): Image[] {
  const all = periods.reduce((bits, length, axis) => (length > 0 ? bits | (1 << axis) : bits), 0);
  const sets = [0, 1, 2, 3, 4, 5, 6, 7].filter((bits) => (bits & ~all) === 0);
  return sets.map((bits) => ({ axes: Float32Array.from([0, 1, 2], (axis) => (bits >> axis) & 1), bits }));
}
