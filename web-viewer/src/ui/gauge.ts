import { niceBelow } from "../colour/range";
import type { Camera } from "../camera/camera";
import { length } from "../format";
import { h, setText } from "./dom";

const size = 56; // px, of the axes
const arm = 20; // px, of an axis in the plane of the picture
const longest = 96; // px, of the scale bar
const names = ["x", "y", "z"] as const;

/** Shows the directions of the axes, and a length of the scene at the distance of the view's middle. */
export class Gauge {
  private readonly lines: SVGLineElement[];
  private readonly labels: SVGTextElement[];
  private readonly bar = h("i");
  private readonly text = h("span", { "data-testid": "scale-length" });
  readonly element: HTMLElement;
  private azimuth = NaN; // of the axes as drawn
  private elevation = NaN;
  private metresPerPixel = 0; // of the scale bar as drawn

  constructor() {
    const svg = svgOf("svg", { viewBox: `0 0 ${size} ${size}`, width: `${size}`, height: `${size}`, class: "axes" });
    svg.setAttribute("aria-hidden", "true");
    this.lines = names.map((name) => svgOf("line", { class: name, x1: `${size / 2}`, y1: `${size / 2}` }));
    this.labels = names.map((name) => svgOf("text", { class: name, "text-anchor": "middle", dy: "0.35em" }));
    this.labels.forEach((label, axis) => (label.textContent = names[axis] ?? ""));
    svg.append(...this.lines, ...this.labels);
    const title = "Length at the distance of the middle of the picture";
    const scale = h("div", { class: "scale-bar", title }, this.text, this.bar);
    this.element = h("section", { class: "gauge", hidden: true, "aria-label": "Scale and axes" });
    this.element.append(svg, scale);
  }

  /** `known`: there is a scene. */
  update({ pose, last }: Camera, known: boolean): void {
    this.element.hidden = !known;
    if (!known) return;
    const { azimuth, elevation } = pose;
    if (azimuth !== this.azimuth || elevation !== this.elevation) this.drawAxes(azimuth, elevation);
    const metresPerPixel = (2 * last.halfTangent * last.distance) / last.height;
    if (metresPerPixel !== this.metresPerPixel) this.drawBar(metresPerPixel);
  }

  private drawAxes(azimuth: number, elevation: number): void {
    this.azimuth = azimuth;
    this.elevation = elevation;
    const ca = Math.cos(azimuth);
    const sa = Math.sin(azimuth);
    const ce = Math.cos(elevation);
    const se = Math.sin(elevation);
    const right = [-sa, ca, 0]; // the directions of the picture, in the axes of the scene
    const up = [-se * ca, -se * sa, ce];
    for (let axis = 0; axis < 3; axis++) {
      const x = right[axis] as number;
      const y = -(up[axis] as number);
      place(this.lines[axis], "x2", "y2", size / 2 + arm * x, size / 2 + arm * y);
      place(this.labels[axis], "x", "y", size / 2 + (arm + 7) * x, size / 2 + (arm + 7) * y);
    }
  }

  private drawBar(metresPerPixel: number): void {
    this.metresPerPixel = metresPerPixel;
    const metres = niceBelow(longest * metresPerPixel);
    this.bar.style.width = `${(metres / metresPerPixel).toFixed(1)}px`;
    setText(this.text, length(metres));
  }
}

function svgOf<Tag extends keyof SVGElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, string>,
): SVGElementTagNameMap[Tag] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

function place(element: SVGElement | undefined, x: string, y: string, left: number, top: number): void {
  element?.setAttribute(x, left.toFixed(1));
  element?.setAttribute(y, top.toFixed(1));
}
