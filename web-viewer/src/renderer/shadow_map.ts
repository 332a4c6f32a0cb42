import type { Environment } from "./environment";
import type { Light } from "./light";
import { bindTexture, program } from "./program";
import type { Program } from "./program";
import type { SphereData } from "./spheres";
import { placeParts } from "./sphere_pass";
import { texture } from "./table";
import emptyFragment from "./shaders/empty.frag.glsl";
import frame from "./shaders/frame.glsl";
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
    this.spheres = program(gl, [frame, ...placeParts, shadowVertex], [shadowFragment]);
    this.solids = program(gl, [solidVertex], [frame, emptyFragment]);
    this.texture = texture(gl, gl.DEPTH_COMPONENT24, size, size, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
    this.framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.texture, 0);
  }

  /** The uniform block of the image must be filled. */
  draw(light: Light, data: SphereData, mix: number, environment: Environment): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.viewport(0, 0, this.size, this.size);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 4);
    this.spheres.use();
    gl.uniformMatrix4fv(this.spheres.at("u_light"), false, light.clip);
    const { right, up } = light;
    gl.uniform3f(this.spheres.at("u_right"), right[0], right[1], right[2]);
    gl.uniform3f(this.spheres.at("u_up"), up[0], up[1], up[2]);
    data.prepare(this.spheres, mix);
    data.draw(this.spheres, 0, data.count);
    this.solids.use();
    gl.uniformMatrix4fv(this.solids.at("u_matrix"), false, light.clip);
    gl.uniform3f(this.solids.at("u_from"), 0, 0, 0);
    environment.drawObstacles(this.solids, false);
    environment.drawObstacles(this.solids, true);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** Binds the map for programs that include shaders/light.glsl. */
  bind(): void {
    bindTexture(this.gl, "u_shadow", this.texture);
  }

  free(): void {
    this.spheres.free();
    this.solids.free();
    this.gl.deleteTexture(this.texture);
    this.gl.deleteFramebuffer(this.framebuffer);
  }
}
