import { bufferOf, columnFormats, columnNames, valuesOf } from "../columns";
import type { Facts } from "../model/facts";
import { capacity } from "../model/playout";
import { joined } from "../model/population";
import type { Population, Run } from "../model/population";
import type { Shown, State } from "../model/states";
import { slot } from "./program";
import type { Attribute, Program } from "./program";

/** A buffer on the device, and the state that it holds. */
interface Resident {
  buffer: WebGLBuffer;
  state: State | undefined;
  used: number; // value of `turn` at its last use
}

/**
 * The spheres' data on the device, per place: states as received (float32), and radius, id and group colour, which
 * change with the population.
 */
export class SphereData {
  count = 0; // places
  private readonly array: WebGLVertexArrayObject;
  private readonly residents: Resident[];
  private readonly radii: WebGLBuffer;
  private readonly ids: WebGLBuffer;
  private readonly colours: WebGLBuffer;
  private facts: Facts | undefined;
  private tabled = false; // the buffers hold ids
  private turn = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.array = gl.createVertexArray();
    this.residents = Array.from({ length: capacity }, () => ({ buffer: gl.createBuffer(), state: undefined, used: 0 }));
    this.radii = gl.createBuffer();
    this.ids = gl.createBuffer();
    this.colours = gl.createBuffer();
  }

  setFacts(facts: Facts): void {
    const { gl } = this;
    const { population } = facts;
    this.facts = facts;
    this.tabled = population.ids !== undefined;
    gl.bindVertexArray(this.array);
    this.setFloats("a_radius", this.radii, population.radii);
    this.setFloats("a_id", this.ids, population.ids && new Float32Array(population.ids));
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colours);
    gl.bufferData(gl.ARRAY_BUFFER, colours(population, 0, population.places), gl.STATIC_DRAW);
    this.perInstance("a_group");
    gl.vertexAttribPointer(slot("a_group"), 4, gl.UNSIGNED_BYTE, true, 4, 0);
    gl.bindVertexArray(null);
  }

  /** Uploads what has changed in the population. `changed`: the places whose sphere has changed. */
  updatePopulation(changed: readonly Run[]): void {
    const { facts } = this;
    if (!facts) return;
    const { population } = facts;
    const spans = joined(changed, Math.max(64, population.places >> 8)); // few uploads
    if (this.tabled && population.ids) for (const span of spans) this.uploadTables(population, span);
    else this.setFacts(facts);
    for (const { buffer, state } of this.residents) {
      // The buffer of a state that is not needed any more has returned to the worker.
      if (state && bufferOf(state.columns).byteLength > 0) this.uploadValues(buffer, state, spans);
    }
  }

  /** Selects the states to draw, and uploads those that are new. */
  show(shown: Shown): void {
    const { gl } = this;
    this.count = Math.min(shown.from.count, shown.to.count, this.facts?.population.places ?? 0);
    gl.bindVertexArray(this.array);
    for (const [end, state] of [
      ["From", shown.from],
      ["To", shown.to],
    ] as const) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.resident(state));
      for (const name of columnNames) {
        const { components } = columnFormats[name];
        const input = `a_${name}${end}` as const;
        const column = state.columns[name];
        if (!column) {
          gl.disableVertexAttribArray(slot(input));
          continue;
        }
        this.perInstance(input);
        const { BYTES_PER_ELEMENT: bytes, byteOffset } = column.values;
        gl.vertexAttribPointer(slot(input), components, gl.FLOAT, false, bytes * components, byteOffset);
      }
    }
    gl.bindVertexArray(null);
  }

  /**
   * Draws all spheres in one instanced call, with a program that includes shaders/position.glsl. Spheres that reach
   * across a face of a periodic axis are drawn again at the other face, with one more call for each set of axes.
   */
  draw(program: Program, mix: number): void {
    const { gl, facts } = this;
    if (!facts || this.count === 0) return;
    gl.uniform1f(program.at("u_mix"), mix);
    gl.vertexAttrib1f(slot("a_radius"), facts.population.radius);
    gl.vertexAttrib1f(slot("a_id"), -1);
    gl.bindVertexArray(this.array);
    gl.uniform3fv(program.at("u_period"), facts.periods);
    gl.uniform3fv(program.at("u_perLength"), facts.periods.map((length) => (length > 0 ? 1 / length : 0)));
    for (const image of imagesOf(facts)) {
      gl.uniform3fv(program.at("u_image"), image);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    }
    gl.bindVertexArray(null);
  }

  private resident(state: State): WebGLBuffer {
    this.turn += 1;
    let found = this.residents.find((resident) => resident.state === state);
    if (!found) {
      found = this.residents.reduce((oldest, other) => (other.used < oldest.used ? other : oldest));
      this.gl.bindBuffer(this.gl.ARRAY_BUFFER, found.buffer);
      this.gl.bufferData(this.gl.ARRAY_BUFFER, valuesOf(state.columns), this.gl.STREAM_DRAW);
      found.state = state;
    }
    found.used = this.turn;
    return found.buffer;
  }

  /** Fills the buffer of an input with one value per place. Undefined: the input has the same value at all places. */
  private setFloats(input: Attribute, buffer: WebGLBuffer, values: Float32Array | undefined): void {
    const { gl } = this;
    if (!values) return gl.disableVertexAttribArray(slot(input));
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    this.perInstance(input);
    gl.vertexAttribPointer(slot(input), 1, gl.FLOAT, false, 4, 0);
  }

  private uploadTables(population: Population, { first, count }: Run): void {
    const { radii, ids } = population;
    const end = first + count;
    if (radii) this.upload(this.radii, 4 * first, radii.subarray(first, end));
    if (ids) this.upload(this.ids, 4 * first, new Float32Array(ids.subarray(first, end)));
    this.upload(this.colours, 4 * first, colours(population, first, count));
  }

  private uploadValues(buffer: WebGLBuffer, state: State, spans: readonly Run[]): void {
    for (const name of columnNames) {
      const { components } = columnFormats[name];
      const values = state.columns[name]?.values;
      if (!values) continue;
      for (const { first, count } of spans) {
        const part = values.subarray(components * first, components * (first + count));
        this.upload(buffer, part.byteOffset, part);
      }
    }
  }

  private upload(buffer: WebGLBuffer, at: number, values: Float32Array | Uint8Array): void {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, buffer);
    this.gl.bufferSubData(this.gl.ARRAY_BUFFER, at, values);
  }

  private perInstance(name: Attribute): void {
    this.gl.enableVertexAttribArray(slot(name));
    this.gl.vertexAttribDivisor(slot(name), 1);
  }
}

/** All sets of periodic axes, as 1 per axis in the set and 0 for the others. The first one is empty. */
function imagesOf({ periods }: Facts): number[][] {
  return periods.reduce<number[][]>(
    (sets, length, axis) =>
      length > 0 ? [...sets, ...sets.map((set) => set.map((one, k) => (k === axis ? 1 : one)))] : sets,
    [[0, 0, 0]],
  );
}

/** The colour of the group at each place (sRGB), four bytes per place. */
function colours(population: Population, first: number, count: number): Uint8Array {
  const bytes = new Uint8Array(4 * count).fill(160);
  for (let k = 0; k < count; k++) {
    const colour = population.groupOf(first + k)?.colour;
    colour?.forEach((part, c) => (bytes[4 * k + c] = Math.round(255 * part)));
  }
  return bytes;
}
