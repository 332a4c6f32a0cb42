import * as mat4 from "gl-matrix/esm/mat4.js";
import type { View } from "../camera/view";
import { program } from "./program";
import type { Program } from "./program";
import { texture } from "./scene_target";
import type { SceneTarget } from "./scene_target";
import compositeFragment from "./shaders/composite.frag.glsl";
import occlusionFragment from "./shaders/occlusion.frag.glsl";
import screen from "./shaders/screen.vert.glsl";

/** Post-processing: copies the drawn scene to the canvas, with ambient occlusion if the quality includes it. */
export class PostPass {
  private readonly composite: Program;
  private readonly occlusion: Program | undefined;
  private readonly openness: WebGLTexture | undefined;
  private readonly framebuffer: WebGLFramebuffer | undefined;
  private readonly half: [number, number];

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly target: SceneTarget,
    occlusion: boolean,
  ) {
    this.half = [Math.ceil(target.width / 2), Math.ceil(target.height / 2)];
    this.composite = program(gl, [screen], [compositeFragment], occlusion ? ["OCCLUSION"] : []);
    if (!occlusion) return;
    this.occlusion = program(gl, [screen], [occlusionFragment]);
    this.openness = texture(gl, gl.R8, ...this.half, gl.LINEAR);
    this.framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.openness, 0);
  }

  /** `reach`: m within which surfaces darken each other; `dim`: 0..1, how stale the image is; `haze`: grey over it. */
  draw(view: View, reach: number, dim: number, haze: number): void {
    const { gl, target, composite } = this;
    gl.disable(gl.DEPTH_TEST);
    this.drawOcclusion(view, reach);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, target.width, target.height);
    composite.use();
    this.bind(0, target.colour, composite, "u_scene");
    if (this.openness) {
      this.bind(1, this.openness, composite, "u_occlusion");
      this.bind(2, target.depth, composite, "u_depth");
      gl.uniform2f(composite.at("u_planes"), view.near, view.far);
    }
    gl.uniform1f(composite.at("u_dim"), dim);
    gl.uniform1f(composite.at("u_haze"), haze);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
  }

  free(): void {
    if (this.openness) this.gl.deleteTexture(this.openness);
    if (this.framebuffer) this.gl.deleteFramebuffer(this.framebuffer);
  }

  private drawOcclusion(view: View, reach: number): void {
    const { gl, occlusion, framebuffer, target } = this;
    if (!occlusion || !framebuffer) return;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.viewport(0, 0, ...this.half);
    occlusion.use();
    this.bind(0, target.depth, occlusion, "u_depth");
    const unproject = mat4.invert(mat4.create(), view.projection) ?? mat4.create();
    gl.uniformMatrix4fv(occlusion.at("u_unproject"), false, unproject);
    gl.uniform1f(occlusion.at("u_reach"), reach);
    gl.uniform1f(occlusion.at("u_scale"), 0.5 / view.halfTangent);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  private bind(unit: number, bound: WebGLTexture, to: Program, name: string): void {
    this.gl.activeTexture(this.gl.TEXTURE0 + unit);
    this.gl.bindTexture(this.gl.TEXTURE_2D, bound);
    this.gl.uniform1i(to.at(name), unit);
  }
}
