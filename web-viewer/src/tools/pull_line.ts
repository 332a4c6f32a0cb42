import { project } from "../camera/ray";
import type { View } from "../camera/view";
import { figure } from "../format";
import type { Vec3 } from "../model/facts";
import { h, setText } from "../ui/dom";

const svgName = "http://www.w3.org/2000/svg";

/** The line from a pulled sphere to the point, with the force as text. */
export class PullLine {
  private readonly line = document.createElementNS(svgName, "line");
  private readonly point = document.createElementNS(svgName, "circle");
  private readonly text = h("output", { "data-testid": "pull-force", "aria-label": "Force of the pull" });
  private readonly element: HTMLElement;

  constructor(container: HTMLElement) {
    const svg = document.createElementNS(svgName, "svg");
    svg.setAttribute("aria-hidden", "true");
    this.point.setAttribute("r", "5");
    svg.append(this.line, this.point);
    this.element = h("div", { class: "pull-line", hidden: true }, this.text);
    this.element.prepend(svg);
    container.append(this.element);
  }

  hide(): void {
    this.element.hidden = true;
  }

  /** `force`: undefined if it is not known yet. */
  show(view: View, sphere: Vec3, point: Vec3, force: Vec3 | undefined): void {
    const from = project(view, sphere);
    const to = project(view, point);
    this.element.hidden = !from || !to;
    if (!from || !to) return;
    const set = (element: SVGElement, values: Record<string, number>): void => {
      for (const [name, value] of Object.entries(values)) element.setAttribute(name, value.toFixed(1));
    };
    set(this.line, { x1: from[0], y1: from[1], x2: to[0], y2: to[1] });
    set(this.point, { cx: to[0], cy: to[1] });
    const [x, y] = [Math.min(to[0] + 12, view.width - 90), Math.max(to[1] - 34, 4)];
    this.text.style.transform = `translate(${x.toFixed(0)}px, ${y.toFixed(0)}px)`;
    setText(this.text, force ? `${figure(Math.hypot(...force))} N` : "…");
  }
}
