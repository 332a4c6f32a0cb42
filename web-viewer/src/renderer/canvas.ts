import type { View } from "../camera/view";
import type { DrawState } from "./draw_state";
import { FrameRenderer } from "./frame_renderer";
import { placeIn } from "./scene_target";
import { pictureOf } from "./picture";
import { best, RenderQualityControl } from "./render_quality";
import type { RenderQualityChoice } from "./render_quality";
import { themes } from "./theme";
import type { ThemeName } from "./theme";
import type { Facts } from "../model/facts";
import type { Graphics } from "../model/page_state";
import type { Run } from "../model/population";
import type { DrawOrder, Shown } from "../model/states";

/** The canvas and its WebGL context, which the browser may take away and give back. */
export class Canvas {
  drawn = 0; // images since the page was loaded
  graphics: Graphics = "ok";
  private renderer: FrameRenderer | undefined; // undefined: the page cannot draw
  private readonly quality: RenderQualityControl;
  private facts: Facts | undefined;
  private order: DrawOrder | undefined;
  private busy = false; // a picture is made
  private hidden: ReadonlySet<number> = new Set();
  private theme: ThemeName = "light";
  private size: [number, number] = [1, 1]; // CSS pixels

  /** `restored` is called when a lost context is available again. */
  constructor(
    private readonly element: HTMLCanvasElement,
    choice: RenderQualityChoice,
    restored: () => void,
  ) {
    const gl = element.getContext("webgl2", {
      antialias: false,
      alpha: false,
      depth: false,
      powerPreference: "high-performance",
    });
    this.quality = new RenderQualityControl(choice, !gl || drawsInSoftware(gl));
    if (!gl) {
      this.graphics = "none";
      return;
    }
    this.renderer = new FrameRenderer(gl);
    element.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // asks the browser to restore the context
      this.renderer = undefined;
      this.graphics = "lost";
      element.classList.add("empty");
    });
    element.addEventListener("webglcontextrestored", () => {
      this.renderer = new FrameRenderer(gl);
      this.graphics = "ok";
      this.renderer.hide(this.hidden);
      if (this.facts) this.renderer.setFacts(this.facts, themes[this.theme], this.order);
      this.fit();
      restored();
    });
  }

  setFacts(facts: Facts): void {
    if (facts.population.places !== this.facts?.population.places) this.quality.restart();
    if (this.order?.epoch !== facts.epoch) this.order = undefined;
    this.facts = facts;
    this.renderer?.setFacts(facts, themes[this.theme], this.order);
    this.fit();
  }

  setOrder(order: DrawOrder): void {
    if (order.epoch !== this.facts?.epoch) return;
    this.order = order;
    this.renderer?.setOrder(order);
  }

  /** `changed`: the places whose sphere has changed. */
  updatePopulation(changed: readonly Run[]): void {
    this.renderer?.updatePopulation(changed);
  }

  /** `hidden`: numbers of the groups that images leave out. */
  hide(hidden: ReadonlySet<number>): void {
    this.hidden = hidden;
    this.renderer?.hide(hidden);
  }

  setTheme(theme: ThemeName): void {
    this.theme = theme;
    if (this.facts) this.renderer?.setFacts(this.facts, themes[theme], this.order);
  }

  choose(choice: RenderQualityChoice): void {
    this.quality.choose(choice);
    this.fit();
  }

  resize(width: number, height: number): void {
    // The height alone changes when a phone shows or hides its address bar.
    if (width !== this.size[0]) this.quality.restart();
    this.size = [width, height];
    this.fit();
  }

  /**
   * Draws an image. `elapsed`: ms since the last one if drawing is continuous, else undefined. Returns false if the
   * page cannot draw, or not now.
   */
  draw(shown: Shown | undefined, state: DrawState, elapsed: number | undefined): boolean {
    if (!this.renderer || this.busy) return false;
    if (elapsed !== undefined && this.quality.took(elapsed)) this.fit();
    this.renderer.draw(shown, state);
    this.element.classList.toggle("empty", !this.facts);
    this.drawn += 1;
    return true;
  }

  /**
   * Draws a picture in full quality and returns it as PNG; undefined if `progress` has returned false. Meanwhile no
   * images are drawn. `view`: of the whole picture. Rejects with an Error that tells the user what is wrong.
   */
  async picture(
    shown: Shown | undefined,
    state: DrawState,
    width: number,
    height: number,
    progress: (share: number) => boolean,
  ): Promise<Blob | undefined> {
    const draw = (view: View, tileWidth: number, tileHeight: number): ImageData => {
      const { renderer } = this;
      if (!renderer) throw new Error("The browser has taken the graphics device away. Try again.");
      renderer.setQuality(best, tileWidth, tileHeight);
      return new ImageData(renderer.pixels(shown, { ...state, view }), tileWidth, tileHeight);
    };
    this.busy = true;
    try {
      return await pictureOf(state.view, width, height, draw, progress);
    } finally {
      this.busy = false;
      this.fit();
    }
  }

  /** Whether images have the full quality at present. */
  get full(): boolean {
    return this.quality.quality.full;
  }

  /** The place of the sphere that the last image shows at a point (CSS pixels from the upper left corner). */
  placeAt(x: number, y: number): number | undefined {
    const { width, height } = this.element;
    const column = Math.floor((x * width) / this.size[0]);
    const row = Math.floor((y * height) / this.size[1]);
    return this.renderer?.placeAt(column, height - 1 - row);
  }

  /** The places of the spheres in the last image, row after row from the top; negative: none. For tests. */
  places(): { width: number; height: number; places: Int32Array } | undefined {
    const { width, height } = this.element;
    const codes = this.renderer?.codes();
    if (codes?.length !== width * height) return undefined;
    const places = new Int32Array(codes.length);
    for (let row = 0; row < height; row++) {
      for (let column = 0; column < width; column++) {
        places[(height - 1 - row) * width + column] = placeIn(codes[row * width + column] ?? 0) ?? -1;
      }
    }
    return { width, height, places };
  }

  private fit(): void {
    if (this.busy) return;
    const { quality } = this.quality;
    const scale = Math.min(window.devicePixelRatio, quality.scale);
    const [width, height] = this.size.map((side) => Math.max(1, Math.round(side * scale))) as [number, number];
    if (this.element.width !== width || this.element.height !== height) {
      this.element.width = width;
      this.element.height = height;
    }
    this.renderer?.setQuality(quality, width, height);
  }
}

function drawsInSoftware(gl: WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
