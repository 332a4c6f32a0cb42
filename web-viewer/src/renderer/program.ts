import { columnFormats, columnNames } from "../columns";
import type { ColumnName } from "../columns";

/** A linked program, with its uniforms by name. */
export interface Program {
  use(): void;
  at(uniform: string): WebGLUniformLocation | null;
  free(): void;
}

/** The table of a column: its values in one of the two states that are interpolated. */
type ColumnTable = `u_${ColumnName}${"From" | "To"}`;

const columnTables = columnNames.flatMap((name): ColumnTable[] => [`u_${name}From`, `u_${name}To`]);

/** Textures have the same units in all programs, so that a texture is bound once for several programs. */
const samplers = [
  "u_shadow",
  "u_code",
  "u_depth",
  "u_forward",
  "u_scene",
  "u_openness",
  "u_order",
  "u_radius",
  "u_id",
  "u_group",
  "u_looks",
  ...columnTables,
] as const;
export type Sampler = (typeof samplers)[number];

/** GLSL: the tables of all columns, and functions of a place: its values in both states. */
export const columnDeclarations = columnNames
  .map((name) => {
    const { components, whole } = columnFormats[name];
    const [type, parts] = components === 1 ? ["float", "r"] : [whole ? "ivec3" : "vec3", "rgb"];
    const fetch = (end: string): string => `texelFetch(u_${name}${end}, texelOf(place), 0).${parts}`;
    return [
      `uniform ${whole ? "i" : ""}sampler2D u_${name}From, u_${name}To;`,
      `${type} ${name}From(int place) { return ${fetch("From")}; }`,
      `${type} ${name}To(int place) { return ${fetch("To")}; }`,
    ].join("\n");
  })
  .join("\n");

export function bindTexture(gl: WebGL2RenderingContext, sampler: Sampler, texture: WebGLTexture): void {
  gl.activeTexture(gl.TEXTURE0 + samplers.indexOf(sampler));
  gl.bindTexture(gl.TEXTURE_2D, texture);
}

/** Attribute slots are the same in all programs, so that programs can share vertex arrays. */
const attributes = ["a_position", "a_normal", "a_colour"] as const;
export type Attribute = (typeof attributes)[number];

export function slot(attribute: Attribute): number {
  return attributes.indexOf(attribute);
}

export const frameBinding = 0; // binding point of the uniform block Frame

/**
 * Compiles and links a program. Sources are given in parts, which are concatenated. Throws an Error with the compiler's
 * log if that fails.
 */
export function program(
  gl: WebGL2RenderingContext,
  vertex: string[],
  fragment: string[],
  defines: string[] = [],
): Program {
  const linked = gl.createProgram();
  const precise = ["float", "int", "sampler2D", "isampler2D", "usampler2D", "sampler2DShadow"];
  const precision = precise.map((type) => `precision highp ${type};`);
  const head = ["#version 300 es", ...precision, ...defines.map((name) => `#define ${name}`)];
  for (const [type, parts] of [
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ] as const) {
    const shader = gl.createShader(type);
    if (!shader) throw new Error("no shader: the WebGL context is lost");
    gl.shaderSource(shader, [...head, ...parts].join("\n"));
    gl.compileShader(shader);
    gl.attachShader(linked, shader);
    gl.deleteShader(shader); // with the program
  }
  attributes.forEach((name, index) => gl.bindAttribLocation(linked, index, name));
  gl.linkProgram(linked);
  if (!gl.getProgramParameter(linked, gl.LINK_STATUS) && !gl.isContextLost()) {
    const logs = (gl.getAttachedShaders(linked) ?? []).map((shader) => gl.getShaderInfoLog(shader) ?? "");
    throw new Error(`shader: ${[gl.getProgramInfoLog(linked), ...logs].join("\n").trim()}`);
  }
  const block = gl.getUniformBlockIndex(linked, "Frame");
  if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(linked, block, frameBinding);
  gl.useProgram(linked);
  samplers.forEach((name, unit) => {
    const location = gl.getUniformLocation(linked, name);
    if (location) gl.uniform1i(location, unit);
  });
  const locations = new Map<string, WebGLUniformLocation | null>();
  return {
    use: () => gl.useProgram(linked),
    free: () => gl.deleteProgram(linked),
    at(uniform) {
      let location = locations.get(uniform);
      if (location === undefined) {
        location = gl.getUniformLocation(linked, uniform);
        locations.set(uniform, location);
      }
      return location;
    },
  };
}
