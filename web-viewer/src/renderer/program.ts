import { columnFormats, columnNames } from "../columns";
import type { ColumnName } from "../columns";

/** A linked program, with its uniforms by name. */
export interface Program {
  use(): void;
  at(uniform: string): WebGLUniformLocation | null;
}

/** The inputs of a column: its values in the two states that are interpolated. */
type ColumnInput = `a_${ColumnName}${"From" | "To"}`;

const columnInputs = columnNames.flatMap((name): ColumnInput[] => [`a_${name}From`, `a_${name}To`]);

/** Attribute slots are the same in all programs, so that programs can share vertex arrays. */
const attributes = [...columnInputs, "a_radius", "a_id", "a_group", "a_position", "a_normal", "a_colour"] as const;
export type Attribute = (typeof attributes)[number];

/** GLSL declarations of the inputs of all columns. */
export const columnDeclarations = columnNames
  .map((name) => [name, columnFormats[name].components] as const)
  .map(([name, size]) => `in ${size === 1 ? "float" : `vec${size}`} a_${name}From, a_${name}To;`)
  .join("\n");

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
  const precision = ["precision highp float;", "precision highp int;"];
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
  }
  attributes.forEach((name, index) => gl.bindAttribLocation(linked, index, name));
  gl.linkProgram(linked);
  if (!gl.getProgramParameter(linked, gl.LINK_STATUS) && !gl.isContextLost()) {
    const logs = (gl.getAttachedShaders(linked) ?? []).map((shader) => gl.getShaderInfoLog(shader) ?? "");
    throw new Error(`shader: ${[gl.getProgramInfoLog(linked), ...logs].join("\n").trim()}`);
  }
  const block = gl.getUniformBlockIndex(linked, "Frame");
  if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(linked, block, frameBinding);
  const locations = new Map<string, WebGLUniformLocation | null>();
  return {
    use: () => gl.useProgram(linked),
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
