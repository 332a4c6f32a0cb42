import { bufferOf, columnFormats, columnNames, valuesPerSphere } from "../columns";
import type { Facts } from "../model/facts";
import { capacity } from "../model/playout";
import type { Shown, State } from "../model/states";
import { slot } from "./program";
import type { Attribute, Program } from "./program";

/** A buffer on the device, and the state that it holds. */
interface Resident {
  buffer: WebGLBuffer;
  state: State | undefined;
  used: number; // value of `turn` at its last use
}

/** The spheres' data on the device: states as received (float32), and radius and group colour once per scene. */
export class SphereData {
  count = 0;
  private readonly array: WebGLVertexArrayObject;
  private readonly residents: Resident[];
  private readonly radii: WebGLBuffer;
  private readonly colours: WebGLBuffer;
  private facts: Facts | undefined;
  private turn = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.array = gl.createVertexArray();
    this.residents = Array.from({ length: capacity }, () => ({ buffer: gl.createBuffer(), state: undefined, used: 0 }));
    this.radii = gl.createBuffer();
    this.colours = gl.createBuffer();
  }

  setFacts(facts: Facts): void {
    const { gl } = this;
    this.facts = facts;
    gl.bindVertexArray(this.array);
    if (facts.radii) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.radii);
      gl.bufferData(gl.ARRAY_BUFFER, facts.radii, gl.STATIC_DRAW);
      this.perInstance("a_radius");
      gl.vertexAttribPointer(slot("a_radius"), 1, gl.FLOAT, false, 4, 0);
    } else {
      gl.disableVertexAttribArray(slot("a_radius"));
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colours);
    gl.bufferData(gl.ARRAY_BUFFER, colours(facts), gl.STATIC_DRAW);
    this.perInstance("a_group");
    gl.vertexAttribPointer(slot("a_group"), 4, gl.UNSIGNED_BYTE, true, 4, 0);
    gl.bindVertexArray(null);
  }

  /** Selects the states to draw, and uploads those that are new. */
  show(shown: Shown): void {
    const { gl } = this;
    this.count = Math.min(shown.from.count, shown.to.count, this.facts?.count ?? 0);
    gl.bindVertexArray(this.array);
    for (const [end, state] of [
      ["From", shown.from],
      ["To", shown.to],
    ] as const) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.resident(state));
      for (const name of columnNames) {
        const { components } = columnFormats[name];
        const input = `a_${name}${end}` as const;
        this.perInstance(input);
        const { BYTES_PER_ELEMENT: bytes, byteOffset } = state.columns[name].values;
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
    gl.uniform3fv(program.at("u_origin"), facts.origin);
    gl.uniform1f(program.at("u_mix"), mix);
    gl.vertexAttrib1f(slot("a_radius"), facts.radius);
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
      const values = new Float32Array(bufferOf(state.columns), 0, valuesPerSphere * state.count);
      this.gl.bufferData(this.gl.ARRAY_BUFFER, values, this.gl.STREAM_DRAW);
      found.state = state;
    }
    found.used = this.turn;
    return found.buffer;
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

function colours(facts: Facts): Uint8Array {
  const bytes = new Uint8Array(4 * facts.count).fill(160);
  for (const group of facts.groups) {
    const [r, g, b] = group.colour.map((part) => Math.round(255 * part)) as [number, number, number];
    const end = Math.min(facts.count, group.first + group.count);
    for (let id = group.first; id < end; id++) bytes.set([r, g, b, 255], 4 * id);
  }
  return bytes;
}
