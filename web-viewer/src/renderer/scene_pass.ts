import type { Facts, Vec3 } from "../model/facts";
import type { DrawState } from "./draw_state";
import type { Environment } from "./environment";
import { program } from "./program";
import type { Program } from "./program";
import background from "./shaders/background.frag.glsl";
import floorFragment from "./shaders/floor.frag.glsl";
import frame from "./shaders/frame.glsl";
import light from "./shaders/light.glsl";
import lineFragment from "./shaders/line.frag.glsl";
import noise from "./shaders/noise.glsl";
import screen from "./shaders/screen.vert.glsl";
import solidFragment from "./shaders/solid.frag.glsl";
import solidVertex from "./shaders/solid.vert.glsl";

const seenFromBehind = 0.25; // opacity of obstacles

/** Draws background, floor and obstacles; later translucent surfaces and lines. */
export class ScenePass {
  private readonly background: Program;
  private readonly floor: Program;
  private readonly solids: Program;
  private readonly lines: Program;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    softShadow: boolean,
  ) {
    const soft = softShadow ? ["SOFT_SHADOW"] : [];
    const parts = [frame, noise, light];
    this.background = program(gl, [screen], [...parts, background]);
    this.floor = program(gl, [solidVertex], [...parts, floorFragment], soft);
    this.solids = program(gl, [solidVertex], [...parts, solidFragment], soft);
    this.lines = program(gl, [solidVertex], [...parts, lineFragment]);
  }

  /** `eye`, here and below: relative to the centre of the bounds (m). */
  draw(facts: Facts, state: DrawState, eye: Vec3, environment: Environment): void {
    const { gl } = this;
    gl.depthMask(false);
    this.background.use();
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.depthMask(true);

    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.CULL_FACE);
    this.prepare(this.floor, state, eye);
    const { max, origin } = facts;
    gl.uniform2f(this.floor.at("u_half"), max[0] - origin[0], max[1] - origin[1]);
    gl.uniform1f(this.floor.at("u_ruler"), environment.ruler);
    gl.uniform1f(this.floor.at("u_fade"), environment.fade);
    environment.floor.draw();
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);

    this.prepare(this.solids, state, eye);
    gl.uniform1f(this.solids.at("u_opacity"), 1);
    environment.drawObstacles(this.solids, false);
    gl.enable(gl.CULL_FACE);
    environment.drawObstacles(this.solids, true);
    gl.disable(gl.CULL_FACE);
  }

  /** Draws translucent surfaces and lines, after all that is opaque. */
  drawOver(state: DrawState, eye: Vec3, environment: Environment): void {
    const { gl } = this;
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    this.prepare(this.solids, state, eye);
    gl.enable(gl.CULL_FACE);
    gl.uniform1f(this.solids.at("u_opacity"), 1);
    environment.walls.draw();
    gl.cullFace(gl.FRONT);
    gl.uniform1f(this.solids.at("u_opacity"), seenFromBehind);
    environment.drawObstacles(this.solids, true);
    gl.cullFace(gl.BACK);
    gl.disable(gl.CULL_FACE);
    this.prepare(this.lines, state, eye);
    environment.edges.draw(gl.LINES);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  free(): void {
    for (const used of [this.background, this.floor, this.solids, this.lines]) used.free();
  }

  private prepare(used: Program, state: DrawState, eye: Vec3): void {
    used.use();
    this.gl.uniformMatrix4fv(used.at("u_matrix"), false, state.view.toClip);
    this.gl.uniform3f(used.at("u_from"), eye[0], eye[1], eye[2]);
  }
}
