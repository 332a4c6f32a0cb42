import type { View } from "../camera/view";
import type { Mode } from "../colour/modes";
import type { Ramp } from "../colour/ramp";
import type { Facts } from "../scene/facts";
import type { Shown } from "../scene/states";
import { Finish } from "./finish";
import { FrameBlock } from "./frame";
import { lightFor } from "./light";
import type { Light } from "./light";
import type { Quality } from "./quality";
import { ScenePass } from "./scene_pass";
import { ShadowMap } from "./shadow";
import { SphereData } from "./spheres";
import { Surroundings } from "./surroundings";
import { SceneTarget } from "./target";
import type { Theme } from "./theme";

/** How to draw this picture. */
export interface Paint {
  view: View;
  mode: Mode;
  ramp: Ramp;
  range: [number, number];
  selected: number | undefined;
  dim: number; // 0..1: how stale the picture is
}

/** All that one WebGL context holds; made anew when the context was lost. A picture is: shadow, scene, finish. */
export class Picture {
  private readonly frame: FrameBlock;
  private readonly data: SphereData;
  private readonly around: Surroundings;
  private scene: ScenePass | undefined;
  private shadow: ShadowMap | undefined;
  private target: SceneTarget | undefined;
  private finish: Finish | undefined;
  private facts: Facts | undefined;
  private light: Light | undefined;
  private theme: Theme | undefined;
  private quality: Quality | undefined;
  private shaded = ""; // what the shadow map shows

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.frame = new FrameBlock(gl);
    this.data = new SphereData(gl);
    this.around = new Surroundings(gl);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
  }

  setFacts(facts: Facts, theme: Theme): void {
    this.facts = facts;
    this.theme = theme;
    this.light = lightFor(facts);
    this.data.setFacts(facts);
    this.around.set(facts, theme);
    this.shaded = "";
  }

  /** Sizes in pixels of the canvas. */
  setQuality(quality: Quality, width: number, height: number): void {
    const { gl } = this;
    if (quality !== this.quality) {
      this.shadow?.free();
      this.shadow = new ShadowMap(gl, quality.shadowSize);
      this.scene = new ScenePass(gl, quality);
      this.shaded = "";
    }
    if (quality !== this.quality || width !== this.target?.width || height !== this.target.height) {
      this.finish?.free();
      this.target?.free();
      this.target = new SceneTarget(gl, width, height, quality.samples);
      this.finish = new Finish(gl, this.target, quality.occlusion);
    }
    this.quality = quality;
  }

  draw(shown: Shown | undefined, paint: Paint): void {
    const { facts, light, theme, target, scene, shadow, finish } = this;
    if (!facts || !light || !theme || !target || !scene || !shadow || !finish) return;
    if (shown) this.data.show(shown);
    else this.data.count = 0;
    const shade = shown ? `${shown.from.sequence} ${shown.to.sequence} ${shown.mix}` : "none";
    if (shade !== this.shaded) shadow.draw(light, this.data, shown?.mix ?? 0, this.around.solids);
    this.shaded = shade;
    this.frame.fill(paint.view, light, theme, target.height);
    this.around.face(paint.view.eye);
    target.begin();
    scene.draw(facts, shown, paint, this.around, this.data, shadow);
    target.end();
    finish.draw(paint.view, 2.2 * (facts.radiusRange[0] + facts.radiusRange[1]) * 0.5, paint.dim);
  }
}
