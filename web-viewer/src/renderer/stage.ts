import { Picture } from "./picture";
import type { Paint } from "./picture";
import { QualityControl } from "./quality";
import type { QualityChoice } from "./quality";
import { themes } from "./theme";
import type { ThemeName } from "./theme";
import type { Facts } from "../scene/facts";
import type { Shown } from "../scene/states";

/** The canvas and its WebGL context, through losses of it. */
export class Stage {
  drawn = 0; // pictures since the page was loaded
  private picture: Picture | undefined;
  private readonly control: QualityControl;
  private facts: Facts | undefined;
  private theme: ThemeName = "light";
  private size: [number, number] = [1, 1]; // CSS pixels

  /** `restored` is called when a lost context is back. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    choice: QualityChoice,
    restored: () => void,
  ) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("This browser offers no WebGL 2, which the picture is drawn with.");
    this.control = new QualityControl(choice, drawsInSoftware(gl));
    this.picture = new Picture(gl);
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // asks the browser to give it back
      this.picture = undefined;
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.picture = new Picture(gl);
      if (this.facts) this.picture.setFacts(this.facts, themes[this.theme]);
      this.fit();
      restored();
    });
  }

  get contextLost(): boolean {
    return this.picture === undefined;
  }

  setFacts(facts: Facts): void {
    if (facts.count !== this.facts?.count) this.control.restart();
    this.facts = facts;
    this.picture?.setFacts(facts, themes[this.theme]);
    this.fit();
  }

  setTheme(theme: ThemeName): void {
    this.theme = theme;
    if (this.facts) this.picture?.setFacts(this.facts, themes[theme]);
  }

  choose(choice: QualityChoice): void {
    this.control.choose(choice);
    this.fit();
  }

  resize(width: number, height: number): void {
    if (width !== this.size[0]) this.control.restart(); // a phone's address bar comes and goes
    this.size = [width, height];
    this.fit();
  }

  /** `elapsed`: ms since the last picture, where this one follows it without a rest. True where there is a context. */
  draw(shown: Shown | undefined, paint: Paint, elapsed: number | undefined): boolean {
    if (!this.picture) return false;
    if (elapsed !== undefined && this.control.took(elapsed)) this.fit();
    this.picture.draw(shown, paint);
    this.canvas.classList.toggle("empty", !this.facts);
    this.drawn += 1;
    return true;
  }

  private fit(): void {
    const { quality } = this.control;
    const scale = Math.min(window.devicePixelRatio, quality.scale);
    const [width, height] = this.size.map((side) => Math.max(1, Math.round(side * scale))) as [number, number];
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    this.picture?.setQuality(quality, width, height);
  }
}

function drawsInSoftware(gl: WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
