import { modeNames } from "../colour/modes";
import type { Mode } from "../colour/modes";
import type { AutoRange } from "../colour/range";
import { idRamp, radiusRamp, rampColour, rampGradient, speedRamp } from "../colour/ramp";
import { css } from "../colour/rgb";
import type { Facts } from "../model/facts";
import { h, setText } from "./dom";
import { count, figure, length } from "./format";

const groupsShown = 6;

/** Explains the colours. */
export class Legend {
  private readonly title = h("h2", { "data-testid": "legend-title" });
  private readonly body = h("div", { class: "scale" });
  private readonly low = h("span", { "data-testid": "legend-low" });
  private readonly high = h("span", { "data-testid": "legend-high" });
  private readonly lock: HTMLButtonElement;
  private readonly head: HTMLElement;
  readonly element: HTMLElement;
  private shown = ""; // mode and epoch

  constructor(
    private readonly speeds: AutoRange,
    next: () => void,
  ) {
    const toggle = (): void => this.toggleLock();
    this.lock = h("button", { type: "button", class: "lock", "data-testid": "legend-lock", click: toggle }, "auto");
    this.head = h(
      "button",
      { type: "button", class: "head", title: "Next colour mode", "data-testid": "legend-next", click: next },
      this.title,
    );
    this.element = h(
      "section",
      { class: "legend", "data-testid": "legend", "aria-label": "Colours" },
      h("div", { class: "row" }, this.head, this.lock),
      this.body,
    );
  }

  /** Locks or unlocks the range of speeds. */
  toggleLock(): void {
    this.speeds.locked = !this.speeds.locked;
  }

  update(mode: Mode, facts: Facts | undefined): void {
    this.element.hidden = !facts;
    if (!facts) return;
    const key = `${mode} ${facts.epoch}`;
    if (key !== this.shown) {
      this.shown = key;
      setText(this.title, modeNames[mode]);
      this.lock.hidden = mode !== "speed";
      this.body.replaceChildren(...this.bodyFor(mode, facts));
    }
    if (mode === "speed") {
      setText(this.low, "0");
      setText(this.high, `${figure(this.speeds.high)} m/s`);
      setText(this.lock, this.speeds.locked ? "locked" : "auto");
      this.lock.title = this.speeds.locked ? "Unlock the colour range (L)" : "Lock the colour range (L)";
      this.lock.setAttribute("aria-pressed", String(this.speeds.locked));
    }
  }

  private bodyFor(mode: Mode, facts: Facts): HTMLElement[] {
    switch (mode) {
      case "speed":
        return this.bar(rampGradient(speedRamp));
      case "radius": {
        const [low, high] = facts.radiusRange;
        if (low === high) return [swatch(css(rampColour(radiusRamp, 0)), `all ${length(low)}`)];
        setText(this.low, length(low));
        setText(this.high, length(high));
        return this.bar(rampGradient(radiusRamp));
      }
      case "id":
        setText(this.low, "0");
        setText(this.high, count(Math.max(0, facts.count - 1)));
        return this.bar(rampGradient(idRamp));
      case "cell": {
        if (facts.cellSize <= 0) return [h("p", {}, "this scene has no grid")];
        const cells = facts.cells.map(count).join(" × ");
        return [h("p", {}, `one colour per cell of ${length(facts.cellSize)}`), h("p", {}, `${cells} cells`)];
      }
      case "group": {
        const shown = facts.groups.slice(0, groupsShown);
        const rows = shown.map((group) => swatch(css(group.colour), group.name, count(group.count)));
        const more = facts.groups.length - groupsShown;
        return more > 0 ? [...rows, h("p", {}, `and ${more} more`)] : rows;
      }
    }
  }

  private bar(gradient: string): HTMLElement[] {
    const bar = h("div", { class: "bar", style: `background: ${gradient}` });
    return [bar, h("div", { class: "ends" }, this.low, this.high)];
  }
}

function swatch(colour: string, name: string, figure = ""): HTMLElement {
  const sample = h("i", { style: `background: ${colour}` });
  return h("div", { class: "swatch" }, sample, h("span", {}, name), h("b", {}, figure));
}
