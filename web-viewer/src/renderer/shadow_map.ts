import type { Environment } from "./environment";
import type { Light } from "./light";
import { columnDeclarations, program } from "./program";
import type { Program } from "./program";
import type { SphereData } from "./spheres";
import { texture } from "./scene_target";
import emptyFragment from "./shaders/empty.frag.glsl";
import position from "./shaders/position.glsl";
import shadowFragment from "./shaders/shadow.frag.glsl";
import shadowVertex from "./shaders/shadow.vert.glsl";
import solidVertex from "./shaders/solid.vert.glsl";

/** The shadow map: depth as seen from the light. */
export class ShadowMap {
  private readonly texture: WebGLTexture;
  private readonly framebuffer: WebGLFramebuffer;
  private readonly spheres: Program;
  private readonly solids: Program;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly size: number,
  ) {
    this.spheres = program(gl, [columnDeclarations, position, shadowVertex], [shadowFragment]);
    this.solids = program(gl, [solidVertex], [emptyFragment]);
    this.texture = texture(gl, gl.DEPTH_COMPONENT24, size, size, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
    this.framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.texture, 0);
  }

  draw(light: Light, data: SphereData, mix: number, environment: Environment): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.viewport(0, 0, this.size, this.size);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 4);
    this.spheres.use();
    gl.uniformMatrix4fv(this.spheres.at("u_light"), false, light.clip);
    gl.uniform3fv(this.spheres.at("u_right"), light.right);
    gl.uniform3fv(this.spheres.at("u_up"), light.up);
    data.draw(this.spheres, mix);
    this.solids.use();
    gl.uniformMatrix4fv(this.solids.at("u_matrix"), false, light.clip);
    gl.uniform3f(this.solids.at("u_from"), 0, 0, 0);
    environment.solids.draw();
    environment.facing.draw();
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** Binds the map for a program that includes shaders/light.glsl. */
  bind(to: Program, unit: number): void {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.uniform1i(to.at("u_shadow"), unit);
    gl.uniform1f(to.at("u_shadowTexel"), 1 / this.size);
  }

  free(): void {
    this.gl.deleteTexture(this.texture);
    this.gl.deleteFramebuffer(this.framebuffer);
  }
}
