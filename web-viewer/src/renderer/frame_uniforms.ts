import type { View } from "../camera/view";
import type { Vec3 } from "../model/facts";
import type { Light } from "./light";
import { frameBinding } from "./program";
import { linear } from "./theme";
import type { Theme } from "./theme";

/** The uniform block that all passes of an image share (shaders/frame.glsl). */
export class FrameUniforms {
  private readonly buffer: WebGLBuffer;
  private readonly data = new Float32Array(3 * 16 + 10 * 4);

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.buffer = gl.createBuffer();
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.buffer);
    gl.bufferData(gl.UNIFORM_BUFFER, this.data.byteLength, gl.DYNAMIC_DRAW);
  }

  /** `eye`: relative to the centre of the bounds (m). `pixels`: height of the image. */
  fill(view: View, eye: Vec3, light: Light, theme: Theme, pixels: number): void {
    const pixel = (2 * view.halfTangent) / pixels;
    const values = [
      ...[...view.toClip, ...view.fromClip, ...light.map],
      ...[...eye, pixel],
      ...[...light.direction, theme.shadow],
      ...[...theme.key, 1],
      ...[...theme.sky, 1],
      ...[...theme.ground, 1],
      ...[...linear(theme.backgroundTop), 1],
      ...[...linear(theme.backgroundBottom), 1],
      ...[...linear(theme.tile), 1],
      ...[...linear(theme.surround), 1],
      ...[...linear(theme.ink), 1],
    ];
    this.data.set(values);
    const { gl } = this;
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.buffer);
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, this.data);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, frameBinding, this.buffer);
  }
}
