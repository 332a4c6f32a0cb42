import * as mat4 from "gl-matrix/esm/mat4.js";
import type { Facts } from "../model/facts";
import type { DrawState } from "./draw_state";
import { bindTexture, program } from "./program";
import type { Program } from "./program";
import type { SceneTarget } from "./scene_target";
import { placeParts } from "./sphere_pass";
import type { SphereData } from "./spheres";
import { texture } from "./table";
import compositeFragment from "./shaders/composite.frag.glsl";
import frame from "./shaders/frame.glsl";
import meet from "./shaders/meet.glsl";
import noise from "./shaders/noise.glsl";
import occlusionFragment from "./shaders/occlusion.frag.glsl";
import screen from "./shaders/screen.vert.glsl";

/** Post-processing: copies the scene to the canvas; if `full`, with ambient occlusion, outlines and smooth edges. */
export class PostPass {
  private readonly composite: Program;
  private readonly occlusion: Program | undefined;
  private readonly openness: WebGLTexture | undefined;
  private readonly framebuffer: WebGLFramebuffer | undefined;
  private readonly half: [number, number];
  private readonly unproject = mat4.create();

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly target: SceneTarget,
    full: boolean,
  ) {
    this.half = [Math.ceil(target.width / 2), Math.ceil(target.height / 2)];
    const parts = full ? [frame, ...placeParts, meet, noise, compositeFragment] : [noise, compositeFragment];
    this.composite = program(gl, [screen], parts, full ? ["FULL"] : []);
    if (!full) return;
    this.occlusion = program(gl, [screen], [frame, noise, occlusionFragment]);
    this.openness = texture(gl, gl.R8, ...this.half, gl.LINEAR);
    this.framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.openness, 0);
  }

  /** `mix`: as in Shown; `haze`: grey over a stale image; `output`: where to draw, null: the canvas. */
  draw(
    state: DrawState,
    facts: Facts,
    data: SphereData,
    mix: number,
    haze: number,
    output: WebGLFramebuffer | null,
  ): void {
    const { gl, target, composite } = this;
    const [smallest, largest] = facts.population.radiusRange;
    const radius = 0.5 * (smallest + largest);
    gl.disable(gl.DEPTH_TEST);
    bindTexture(gl, "u_depth", target.depth);
    this.drawOcclusion(state, 2.2 * radius);
    gl.bindFramebuffer(gl.FRAMEBUFFER, output);
    gl.viewport(0, 0, target.width, target.height);
    composite.use();
    bindTexture(gl, "u_scene", target.colour);
    if (this.openness) {
      bindTexture(gl, "u_openness", this.openness);
      data.prepare(composite, mix);
      gl.uniform1f(composite.at("u_reach"), 6 * radius);
    }
    gl.uniform1f(composite.at("u_dim"), state.dim);
    gl.uniform1f(composite.at("u_haze"), haze);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
  }

  free(): void {
    this.composite.free();
    this.occlusion?.free();
    if (this.openness) this.gl.deleteTexture(this.openness);
    if (this.framebuffer) this.gl.deleteFramebuffer(this.framebuffer);
  }

  /** `reach`: m within which surfaces darken each other. */
  private drawOcclusion(state: DrawState, reach: number): void {
    const { gl, occlusion, framebuffer } = this;
    if (!occlusion || !framebuffer) return;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.viewport(0, 0, this.half[0], this.half[1]);
    occlusion.use();
    mat4.invert(this.unproject, state.view.projection);
    gl.uniformMatrix4fv(occlusion.at("u_unproject"), false, this.unproject);
    gl.uniform1f(occlusion.at("u_reach"), reach);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
