import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Facts, Vec3 } from "../model/facts";
import type { Run } from "../model/population";
import type { Shown } from "../model/states";
import type { DrawState } from "./draw_state";
import { Environment } from "./environment";
import { FrameUniforms } from "./frame_uniforms";
import { lightFor } from "./light";
import type { Light } from "./light";
import { PostPass } from "./post";
import type { RenderQuality } from "./render_quality";
import { ScenePass } from "./scene_pass";
import { ShadowMap } from "./shadow_map";
import { SphereData } from "./spheres";
import { SceneTarget } from "./scene_target";
import type { Theme } from "./theme";

/**
 * Draws images in three passes: shadow map, scene, post-processing. It owns all resources of one WebGL context, and is
 * created again after that is lost.
 */
export class FrameRenderer {
  private readonly uniforms: FrameUniforms;
  private readonly spheres: SphereData;
  private readonly environment: Environment;
  private scene: ScenePass | undefined;
  private shadow: ShadowMap | undefined;
  private target: SceneTarget | undefined;
  private post: PostPass | undefined;
  private facts: Facts | undefined;
  private light: Light | undefined;
  private theme: Theme | undefined;
  private quality: RenderQuality | undefined;
  private shadowKey = ""; // identifies the content of the shadow map

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.uniforms = new FrameUniforms(gl);
    this.spheres = new SphereData(gl);
    this.environment = new Environment(gl);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
  }

  setFacts(facts: Facts, theme: Theme): void {
    this.facts = facts;
    this.theme = theme;
    this.light = lightFor(facts);
    this.spheres.setFacts(facts);
    this.environment.set(facts, theme);
    this.shadowKey = "";
  }

  /** `changed`: the places whose sphere has changed. */
  updatePopulation(changed: readonly Run[]): void {
    this.spheres.updatePopulation(changed);
    this.shadowKey = "";
  }

  /** Width and height in pixels of the canvas. */
  setQuality(quality: RenderQuality, width: number, height: number): void {
    const { gl } = this;
    if (quality !== this.quality) {
      this.shadow?.free();
      this.shadow = new ShadowMap(gl, quality.shadowSize);
      this.scene = new ScenePass(gl, quality);
      this.shadowKey = "";
    }
    if (quality !== this.quality || width !== this.target?.width || height !== this.target.height) {
      this.post?.free();
      this.target?.free();
      this.target = new SceneTarget(gl, width, height, quality.samples);
      this.post = new PostPass(gl, this.target, quality.occlusion);
    }
    this.quality = quality;
  }

  draw(shown: Shown | undefined, state: DrawState): void {
    const { facts, light, theme, target, scene, shadow, post } = this;
    if (!facts || !light || !theme || !target || !scene || !shadow || !post) return;
    if (shown) this.spheres.show(shown);
    else this.spheres.count = 0;
    const shadowKey = shown ? `${shown.from.sequence} ${shown.to.sequence} ${shown.mix}` : "none";
    if (shadowKey !== this.shadowKey) shadow.draw(light, this.spheres, shown?.mix ?? 0, this.environment);
    this.shadowKey = shadowKey;
    const eye = vec3.subtract([0, 0, 0], state.view.eye, facts.origin) as Vec3;
    this.uniforms.fill(state.view, eye, light, theme, target.height);
    this.environment.face(state.view.eye);
    target.begin();
    scene.draw(facts, shown, state, eye, this.environment, this.spheres, shadow);
    target.end();
    const [smallest, largest] = facts.population.radiusRange;
    post.draw(state.view, 2.2 * (smallest + largest) * 0.5, state.dim, theme.haze);
  }
}
