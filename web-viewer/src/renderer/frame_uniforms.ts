import * as vec3 from "gl-matrix/esm/vec3.js";
import type { View } from "../camera/view";
import type { HalfSpace } from "../model/cut";
import type { Vec3 } from "../model/facts";
import type { Light } from "./light";
import { frameBinding } from "./program";
import { linear } from "./theme";
import type { Theme } from "./theme";

const matrixFloats = 16;
const vectorFloats = 4;
const perImage = 3 * matrixFloats + 5 * vectorFloats; // floats that depend on the view
const all = perImage + 9 * vectorFloats;

/** The uniform block that all passes of an image share (shaders/frame.glsl). */
export class FrameUniforms {
  private readonly buffer: WebGLBuffer;
  private readonly data = new Float32Array(all);

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.buffer = gl.createBuffer();
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.buffer);
    gl.bufferData(gl.UNIFORM_BUFFER, this.data.byteLength, gl.DYNAMIC_DRAW);
  }

  setLight(light: Light, theme: Theme): void {
    const { data } = this;
    data.set(light.map, 2 * matrixFloats);
    const vectors = [
      [...light.direction, theme.shadow],
      light.key,
      light.sky,
      light.ground,
      linear(theme.backgroundTop),
      linear(theme.backgroundBottom),
      linear(theme.tile),
      linear(theme.surround),
      linear(theme.ink),
    ];
    vectors.forEach((vector, k) => data.set(vector, perImage + k * vectorFloats));
  }

  /** `eye`: relative to the centre of the bounds (m). `pixel`: see pixelOf(). */
  fill(view: View, eye: Vec3, pixel: number, kept: HalfSpace): void {
    const { gl, data } = this;
    data.set(view.toClip, 0);
    data.set(view.fromClip, matrixFloats);
    let at = 3 * matrixFloats;
    data.set(eye, at);
    data[at + 3] = pixel;
    at += vectorFloats;
    data.set(view.forward, at);
    data[at + 3] = view.orthographic ? 1 : 0;
    at += vectorFloats;
    data[at] = view.near;
    data[at + 1] = view.far;
    at += vectorFloats;
    data.set(kept.normal, at);
    data[at + 3] = kept.offset - vec3.dot(kept.normal, eye);
    at += vectorFloats;
    data[at] = view.part.x;
    data[at + 1] = view.part.y;
    data[at + 2] = view.part.width;
    data[at + 3] = view.part.height;
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.buffer);
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, data);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, frameBinding, this.buffer);
  }
}

/** The height of a pixel (m) at a distance of 1 m, or at all distances if the view is orthographic. */
export function pixelOf(view: View, height: number): number {
  return (2 * view.halfTangent * (view.orthographic ? view.distance : 1)) / height;
}
