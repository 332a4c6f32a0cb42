import type { HalfSpace } from "../model/cut";
import type { Facts, Vec3 } from "../model/facts";
import type { Run } from "../model/population";
import type { DrawOrder, Shown, State } from "../model/states";
import type { DrawState } from "./draw_state";
import { Environment } from "./environment";
import { FrameUniforms, pixelOf } from "./frame_uniforms";
import { lightFor } from "./light";
import type { Light } from "./light";
import { PostPass } from "./post";
import type { RenderQuality } from "./render_quality";
import { ScenePass } from "./scene_pass";
import { placeIn, SceneTarget } from "./scene_target";
import { ShadowMap } from "./shadow_map";
import { SpherePass } from "./sphere_pass";
import { SphereData } from "./spheres";
import { texture } from "./table";
import type { Theme } from "./theme";
import { TracePass } from "./trace_pass";

/** The content of the shadow map: the states as in Shown, and the half-space as in HalfSpace. */
interface Cast {
  known: boolean; // false: the map must be drawn
  from: State | undefined;
  to: State | undefined;
  mix: number;
  x: number;
  y: number;
  z: number;
  offset: number;
}

/**
 * Draws images in passes, which docs/architecture.md lists. It owns all resources of one WebGL context, and is created
 * again after that is lost.
 */
export class FrameRenderer {
  private readonly uniforms: FrameUniforms;
  private readonly data: SphereData;
  private readonly environment: Environment;
  private readonly trace: TracePass;
  private scene: ScenePass | undefined;
  private spheres: SpherePass | undefined;
  private shadow: ShadowMap | undefined;
  private target: SceneTarget | undefined;
  private post: PostPass | undefined;
  private facts: Facts | undefined;
  private order: DrawOrder | undefined;
  private light: Light | undefined;
  private theme: Theme | undefined;
  private quality: RenderQuality | undefined;
  private readonly eye: Vec3 = [0, 0, 0]; // of the last image, relative to the centre of the bounds
  private readonly cast: Cast = { known: false, from: undefined, to: undefined, mix: 0, x: 0, y: 0, z: 0, offset: 0 };

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.uniforms = new FrameUniforms(gl);
    this.data = new SphereData(gl);
    this.environment = new Environment(gl);
    this.trace = new TracePass(gl);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
  }

  /** `order`: of drawing; undefined: by place. */
  setFacts(facts: Facts, theme: Theme, order: DrawOrder | undefined): void {
    this.facts = facts;
    this.theme = theme;
    this.light = lightFor(facts, theme);
    this.uniforms.setLight(this.light, theme);
    this.data.setFacts(facts);
    this.environment.set(facts, theme);
    this.setOrder(order);
  }

  setOrder(order: DrawOrder | undefined): void {
    this.order = order;
    this.data.setOrder(order);
    if (this.facts) this.spheres?.setFacts(this.facts, order);
    this.cast.known = false;
  }

  /** `changed`: the places whose sphere has changed. */
  updatePopulation(changed: readonly Run[]): void {
    this.data.updatePopulation(changed);
    if (this.facts) this.spheres?.setFacts(this.facts, this.order);
    this.cast.known = false;
  }

  /** `hidden`: numbers of the groups that images leave out. */
  hide(hidden: ReadonlySet<number>): void {
    this.data.hide(hidden);
    this.cast.known = false;
  }

  /** Width and height in pixels of the canvas. */
  setQuality(quality: RenderQuality, width: number, height: number): void {
    const { gl } = this;
    if (quality !== this.quality) {
      this.shadow?.free();
      this.scene?.free();
      this.spheres?.free();
      this.shadow = new ShadowMap(gl, quality.shadowSize);
      this.scene = new ScenePass(gl, quality.full);
      this.spheres = new SpherePass(gl, quality.full);
      if (this.facts) this.spheres.setFacts(this.facts, this.order);
      this.cast.known = false;
    }
    if (quality !== this.quality || width !== this.target?.width || height !== this.target.height) {
      this.post?.free();
      this.target?.free();
      this.target = new SceneTarget(gl, width, height);
      this.post = new PostPass(gl, this.target, quality.full);
    }
    this.quality = quality;
  }

  /** `output`: where to draw; null: the canvas. */
  draw(shown: Shown | undefined, state: DrawState, output: WebGLFramebuffer | null = null): void {
    const { facts, light, theme, target, scene, spheres, shadow, post, data, environment, eye } = this;
    if (!facts || !light || !theme || !target || !scene || !spheres || !shadow || !post) return;
    const { view, kept } = state;
    for (let axis = 0; axis < 3; axis++) eye[axis] = (view.eye[axis] as number) - (facts.origin[axis] as number);
    if (shown) {
      data.show(shown, eye);
      environment.place(shown, facts);
    } else data.count = 0;
    const pixel = pixelOf(view, target.height);
    this.uniforms.fill(view, eye, pixel, kept);
    this.castShadows(shadow, light, shown, kept);
    shadow.bind();
    target.beginForward();
    scene.draw(facts, state, eye, environment);
    target.beginCodes();
    if (shown) spheres.drawCodes(shown, data, state, eye, pixel);
    spheres.shade(facts, shown, state, data, target);
    if (state.trace) this.trace.draw(state.trace, target.width / view.width);
    scene.drawOver(state, eye, environment);
    post.draw(state, facts, data, shown?.mix ?? 0, theme.haze, output);
  }

  /** Draws an image, but not to the canvas, and returns its pixels as RGBA, row after row from the top. */
  pixels(shown: Shown | undefined, state: DrawState): Uint8ClampedArray<ArrayBuffer> {
    const { gl } = this;
    const { width = 0, height = 0 } = this.target ?? {};
    const image = texture(gl, gl.RGBA8, width, height, gl.NEAREST);
    const output = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, output);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, image, 0);
    this.draw(shown, state, output);
    const rows = new Uint8Array(4 * width * height); // from the bottom
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rows);
    gl.deleteFramebuffer(output);
    gl.deleteTexture(image);
    const pixels = new Uint8ClampedArray(rows.length);
    for (let row = 0; row < height; row++) {
      const at = 4 * width * row;
      pixels.set(rows.subarray(at, at + 4 * width), pixels.length - at - 4 * width);
    }
    return pixels;
  }

  /** The place of the sphere at a pixel of the last image, from the lower left corner. */
  placeAt(x: number, y: number): number | undefined {
    const { target } = this;
    if (!target || x < 0 || y < 0 || x >= target.width || y >= target.height) return undefined;
    return placeIn(target.codes(x, y, 1, 1)[0] ?? 0);
  }

  /** The codes of the last image, row after row from the bottom. */
  codes(): Uint32Array | undefined {
    return this.target?.codes(0, 0, this.target.width, this.target.height);
  }

  private castShadows(shadow: ShadowMap, light: Light, shown: Shown | undefined, { normal, offset }: HalfSpace): void {
    const { cast } = this;
    const mix = shown?.mix ?? 0;
    const [x, y, z] = normal;
    const isSameState = cast.from === shown?.from && cast.to === shown?.to && cast.mix === mix;
    if (cast.known && isSameState && cast.x === x && cast.y === y && cast.z === z && cast.offset === offset) return;
    shadow.draw(light, this.data, mix, this.environment);
    cast.known = true;
    cast.from = shown?.from;
    cast.to = shown?.to;
    cast.mix = mix;
    cast.x = x;
    cast.y = y;
    cast.z = z;
    cast.offset = offset;
  }
}
