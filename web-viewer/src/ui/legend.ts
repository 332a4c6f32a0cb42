import { rampGradient } from "../colour/ramp";
import { css } from "../colour/rgb";
import type { ColourRanges } from "../model/colour_ranges";
import type { Facts } from "../model/facts";
import { quantityOf } from "../model/quantities";
import type { LegendContent, Mode, Swatch } from "../model/quantities";
import { focusWhileScrolling, h, setText } from "./dom";
import type { End, RangeEntry } from "../tools/range_entry";
import type { LoadPart } from "./parts";

/** Explains the colours. */
export class Legend {
  private readonly title = h("span", { "data-testid": "legend-title" });
  private readonly body = h("div", { class: "scale" });
  private readonly low = this.end("low", "Set the lowest value");
  private readonly high = this.end("high", "Set the highest value");
  private entry: RangeEntry | undefined; // loaded when it is first needed
  private readonly lock: HTMLButtonElement;
  private readonly head: HTMLElement;
  readonly element: HTMLElement;
  private mode: Mode = "speed";
  private facts: Facts | undefined;
  private shown = ""; // mode, epoch, population and range

  constructor(
    private readonly ranges: ColourRanges,
    private readonly load: LoadPart,
    next: () => void,
  ) {
    const toggle = (): void => this.ranges.toggleLock();
    this.lock = h("button", { type: "button", class: "lock", "data-testid": "legend-lock", click: toggle }, "auto");
    this.head = h(
      "button",
      { type: "button", class: "head", title: "Next colour mode", "data-testid": "legend-next", click: next },
      this.title,
    );
    focusWhileScrolling(this.body);
    this.element = h(
      "section",
      { class: "legend", "data-testid": "legend", "aria-label": "Colours" },
      h("div", { class: "row" }, h("h2", {}, this.head), this.lock),
      this.body,
    );
  }

  update(mode: Mode, facts: Facts | undefined): void {
    this.mode = mode;
    this.facts = facts;
    this.element.hidden = !facts;
    if (!facts) return;
    const { ranges } = this;
    this.entry?.update(mode, facts);
    const range = ranges.of(mode, facts);
    const key = [mode, facts.epoch, facts.population.number, ...range].join(" ");
    if (key !== this.shown) {
      this.shown = key;
      const { label, legend } = quantityOf(mode);
      setText(this.title, label);
      this.lock.hidden = !ranges.isAutomatic(mode);
      this.body.replaceChildren(...this.bodyOf(legend(facts, range)));
    }
    setText(this.lock, ranges.locked ? "locked" : "auto");
    this.lock.title = ranges.locked ? "Unlock the colour range (L)" : "Lock the colour range (L)";
    this.lock.setAttribute("aria-pressed", String(ranges.locked));
  }

  /** The text of an end of the scale, which opens the fields for both ends. */
  private end(end: End, title: string): HTMLElement {
    const click = (): void => void this.edit(end);
    return h("button", { type: "button", class: "end", title, "data-testid": `legend-${end}`, click });
  }

  private async edit(end: End): Promise<void> {
    const part = this.entry ? undefined : await this.load<{ RangeEntry: typeof RangeEntry }>("tools");
    if (part && !this.entry) {
      this.entry = new part.RangeEntry(this.ranges);
      this.element.append(this.entry.element);
    }
    if (this.facts) this.entry?.update(this.mode, this.facts);
    this.entry?.toggle(end);
  }

  private bodyOf(content: LegendContent): HTMLElement[] {
    if ("bar" in content) {
      setText(this.low, content.low);
      setText(this.high, content.high);
      const bar = h("div", { class: "bar", style: `background: ${rampGradient(content.bar)}` });
      return [bar, h("div", { class: "ends" }, this.low, this.high)];
    }
    const swatches = h("div", { class: "swatches" }, ...content.swatches.map(swatchOf));
    return [swatches, ...content.notes.map((note) => h("p", {}, note))];
  }
}

function swatchOf({ colour, name, figure }: Swatch): HTMLElement {
  const sample = h("i", { style: `background: ${css(colour)}` });
  return h("div", { class: "swatch" }, sample, h("bdi", { title: name }, name), h("b", {}, figure));
}
