import type { Facts, Vec3 } from "../model/facts";
import { isSent } from "../model/positions";
import { modes, quantityOf } from "../model/quantities";
import type { DrawOrder, Shown } from "../model/states";
import { Detail, SphereBlocks } from "./blocks";
import type { DrawState } from "./draw_state";
import { bindTexture, columnDeclarations, program } from "./program";
import type { Program } from "./program";
import type { SceneTarget } from "./scene_target";
import type { SphereData } from "./spheres";
import colour from "./shaders/colour.glsl";
import frame from "./shaders/frame.glsl";
import light from "./shaders/light.glsl";
import meet from "./shaders/meet.glsl";
import noise from "./shaders/noise.glsl";
import place from "./shaders/place.glsl";
import pattern from "./shaders/pattern.glsl";
import pointFragment from "./shaders/points.frag.glsl";
import pointVertex from "./shaders/points.vert.glsl";
import screen from "./shaders/screen.vert.glsl";
import shadeFragment from "./shaders/shade.frag.glsl";
import sphereFragment from "./shaders/spheres.frag.glsl";
import spheres from "./shaders/spheres.glsl";
import sphereVertex from "./shaders/spheres.vert.glsl";

/** GLSL: where spheres are drawn. */
export const placeParts = [spheres, columnDeclarations, place];

/** GLSL: the colour (sRGB) of a sphere in each mode. */
const colourNow = [
  "vec3 colourNow(int place, vec3 position) {",
  "switch (u_mode) {",
  ...modes.map((mode, index) => `case ${index}: return ${quantityOf(mode).glsl};`),
  "}",
  "return vec3(0.0);",
  "}",
].join("\n");

/** Draws the spheres: first their codes and depths, then the light of each pixel once. */
export class SpherePass {
  private readonly programs: Record<Detail, Program>;
  private readonly shading: Program;
  private readonly blocks = new SphereBlocks();
  // Arrays of numbers would be copied number by number for each image.
  private readonly cells = Int32Array.of(1, 1, 1);
  private readonly ramps = new Map(
    modes.map((mode) => [mode, Float32Array.from(quantityOf(mode).scale?.ramp.flat() ?? [])]),
  );

  constructor(
    private readonly gl: WebGL2RenderingContext,
    softShadow: boolean,
  ) {
    const parts = [frame, ...placeParts];
    this.programs = {
      [Detail.Point]: program(gl, [...parts, pointVertex], [pointFragment]),
      [Detail.Disc]: program(gl, [...parts, sphereVertex], [frame, meet, sphereFragment]),
      [Detail.Round]: program(gl, [...parts, sphereVertex], [frame, meet, sphereFragment], ["ROUND"]),
    };
    const shadeParts = [...parts, meet, noise, light, colour, colourNow, pattern, shadeFragment];
    this.shading = program(gl, [screen], shadeParts, softShadow ? ["SOFT_SHADOW"] : []);
  }

  free(): void {
    this.shading.free();
    for (const used of Object.values(this.programs)) used.free();
  }

  /** `order`: of drawing; undefined: by place. Call again when the population has changed. */
  setFacts(facts: Facts, order: DrawOrder | undefined): void {
    this.cells.set(facts.cells.map((n) => Math.max(1, n)));
    this.blocks.set(facts, order);
  }

  /** Draws the codes to the target. `eye`: relative to the centre of the bounds (m); `pixel`: see FrameUniforms. */
  drawCodes(shown: Shown, data: SphereData, state: DrawState, eye: Vec3, pixel: number): void {
    const { blocks, programs } = this;
    blocks.find(shown, data.count, state, eye, pixel);
    for (let detail = Detail.Round; detail >= Detail.Point; detail--) {
      let prepared = false;
      for (let k = 0; k < blocks.length; k++) {
        const run = blocks.runs[k];
        if (run?.detail !== detail) continue;
        const used = programs[detail];
        if (!prepared) {
          used.use();
          data.prepare(used, shown.mix);
          prepared = true;
        }
        data.draw(used, run.first, run.count, detail === Detail.Point);
      }
    }
  }

  /** Shades all pixels. Without a state, no pixel shows a sphere. */
  shade(facts: Facts, shown: Shown | undefined, state: DrawState, data: SphereData, target: SceneTarget): void {
    const { gl, shading } = this;
    target.beginScene();
    bindTexture(gl, "u_code", target.code);
    bindTexture(gl, "u_forward", target.forward);
    bindTexture(gl, "u_depth", target.drawnDepth);
    shading.use();
    if (shown) {
      data.prepare(shading, shown.mix);
      const time = shown.to.simTime - shown.from.simTime;
      gl.uniform1f(shading.at("u_inverseTime"), time > 0 ? 1 / time : 0);
      const { sent } = quantityOf(state.mode);
      gl.uniform1i(shading.at("u_valuesSent"), sent && isSent(sent, shown) ? 1 : 0);
      const turns = !state.turns || !shown.to.columns.turn ? 0 : shown.from.columns.turn ? 2 : 1;
      gl.uniform1i(shading.at("u_turns"), turns);
    }
    const ramp = this.ramps.get(state.mode);
    gl.uniform1i(shading.at("u_mode"), modes.indexOf(state.mode));
    if (ramp && ramp.length > 0) gl.uniform3fv(shading.at("u_ramp"), ramp);
    gl.uniform2f(shading.at("u_range"), state.range[0], state.range[1]);
    const { cellWidths, min, origin } = facts;
    gl.uniform1f(shading.at("u_bottom"), min[2] - origin[2]);
    gl.uniform3f(shading.at("u_cellSize"), cellWidths[0], cellWidths[1], cellWidths[2]);
    gl.uniform3iv(shading.at("u_cells"), this.cells);
    gl.uniform1i(shading.at("u_selected"), state.selected ?? -1);
    gl.depthFunc(gl.ALWAYS);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.depthFunc(gl.LEQUAL);
  }
}
