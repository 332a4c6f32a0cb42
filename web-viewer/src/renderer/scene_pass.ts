import type { Facts, Vec3 } from "../model/facts";
import { modes, quantityOf } from "../model/quantities";
import type { Shown } from "../model/states";
import type { DrawState } from "./draw_state";
import type { Environment } from "./environment";
import { columnDeclarations, program } from "./program";
import type { Program } from "./program";
import type { RenderQuality } from "./render_quality";
import type { ShadowMap } from "./shadow_map";
import type { SphereData } from "./spheres";
import background from "./shaders/background.frag.glsl";
import colour from "./shaders/colour.glsl";
import floorFragment from "./shaders/floor.frag.glsl";
import frame from "./shaders/frame.glsl";
import light from "./shaders/light.glsl";
import lineFragment from "./shaders/line.frag.glsl";
import position from "./shaders/position.glsl";
import screen from "./shaders/screen.vert.glsl";
import solidFragment from "./shaders/solid.frag.glsl";
import solidVertex from "./shaders/solid.vert.glsl";
import sphereFragment from "./shaders/spheres.frag.glsl";
import sphereVertex from "./shaders/spheres.vert.glsl";

/** GLSL: the colour of a sphere in each mode. */
const colourNow = [
  "vec3 colourNow(vec3 position) {",
  "switch (u_mode) {",
  ...modes.map((mode, index) => {
    const { glsl, scale } = quantityOf(mode);
    return `case ${index}: return ${scale ? `colourOf(${glsl})` : glsl};`;
  }),
  "}",
  "return vec3(0.0);",
  "}",
].join("\n");

/** Draws the scene: background, floor, obstacles, spheres, then translucent surfaces and lines. */
export class ScenePass {
  private readonly background: Program;
  private readonly floor: Program;
  private readonly solids: Program;
  private readonly spheres: Program;
  private readonly lines: Program;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly quality: RenderQuality,
  ) {
    const soft = quality.softShadow ? ["SOFT_SHADOW"] : [];
    const coverage = quality.samples > 0 ? ["COVERAGE"] : [];
    this.background = program(gl, [screen], [frame, light, background]);
    this.floor = program(gl, [solidVertex], [frame, light, floorFragment], soft);
    this.solids = program(gl, [solidVertex], [frame, light, solidFragment], soft);
    const sphereVertexParts = [frame, columnDeclarations, position, colour, colourNow, sphereVertex];
    this.spheres = program(gl, sphereVertexParts, [frame, light, sphereFragment], [...soft, ...coverage]);
    this.lines = program(gl, [solidVertex], [frame, light, lineFragment]);
  }

  draw(
    facts: Facts,
    shown: Shown | undefined,
    state: DrawState,
    eye: Vec3, // m, relative to the centre of the bounds
    environment: Environment,
    data: SphereData,
    shadow: ShadowMap,
  ): void {
    const { gl } = this;
    gl.depthMask(false);
    this.background.use();
    shadow.bind(this.background, 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.depthMask(true);

    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.enable(gl.CULL_FACE);
    this.prepare(this.floor, state, eye, shadow);
    const [x, y] = facts.max.map((high, axis) => high - (facts.origin[axis] ?? 0));
    gl.uniform2f(this.floor.at("u_half"), x ?? 0, y ?? 0);
    gl.uniform1f(this.floor.at("u_ruler"), environment.ruler);
    gl.uniform1f(this.floor.at("u_fade"), environment.fade);
    environment.floor.draw();
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);

    this.prepare(this.solids, state, eye, shadow);
    environment.solids.draw();
    environment.facing.draw();
    if (shown) this.drawSpheres(facts, shown, state, data, shadow);

    gl.enable(gl.BLEND);
    gl.depthMask(false);
    this.prepare(this.solids, state, eye, shadow);
    environment.veils.draw();
    this.prepare(this.lines, state, eye, shadow);
    environment.edges.draw(gl.LINES);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  private drawSpheres(facts: Facts, shown: Shown, state: DrawState, data: SphereData, shadow: ShadowMap): void {
    const { gl, spheres } = this;
    spheres.use();
    shadow.bind(spheres, 0);
    const time = shown.to.simTime - shown.from.simTime;
    const { scale } = quantityOf(state.mode);
    gl.uniform1i(spheres.at("u_mode"), modes.indexOf(state.mode));
    if (scale) gl.uniform3fv(spheres.at("u_ramp"), scale.ramp.flat());
    gl.uniform2fv(spheres.at("u_range"), state.range);
    gl.uniform1f(spheres.at("u_inverseTime"), time > 0 ? 1 / time : 0);
    const speedsSent = shown?.from.columns.speed && shown.to.columns.speed;
    gl.uniform1i(spheres.at("u_speedsSent"), speedsSent ? 1 : 0);
    gl.uniform3fv(spheres.at("u_cellSize"), facts.cellWidths);
    gl.uniform3iv(spheres.at("u_cells"), facts.cells.map((n) => Math.max(1, n)));
    gl.uniform1i(spheres.at("u_selected"), state.selected ?? -1);
    const smooth = this.quality.samples > 0;
    if (smooth) gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    data.draw(spheres, shown.mix);
    if (smooth) gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  }

  private prepare(used: Program, state: DrawState, eye: Vec3, shadow: ShadowMap): void {
    used.use();
    shadow.bind(used, 0);
    this.gl.uniformMatrix4fv(used.at("u_matrix"), false, state.view.toClip);
    this.gl.uniform3fv(used.at("u_from"), eye);
  }
}
