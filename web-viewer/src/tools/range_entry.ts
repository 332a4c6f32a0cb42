import type { ColourRanges, GivenRange } from "../model/colour_ranges";
import type { Facts } from "../model/facts";
import { quantityOf } from "../model/quantities";
import type { Mode, Scale } from "../model/quantities";
import { h, setText, uniqueId } from "../ui/dom";
import { allowed, entryText, parseEntry } from "../ui/entry";
import type { EntryRule } from "../ui/entry";

export type End = keyof GivenRange;

const ends: readonly End[] = ["low", "high"];
const names: Record<End, string> = { low: "Lowest value", high: "Highest value" };

/** The fields for the ends of a colour scale. An empty field makes its end automatic. */
export class RangeEntry {
  private readonly inputs: Record<End, HTMLInputElement>;
  private readonly unit = h("span");
  private readonly message = h("p", { class: "wrong", id: uniqueId("range"), role: "alert", hidden: true });
  private mode: Mode = "speed";
  private facts: Facts | undefined;
  readonly element: HTMLFormElement;

  constructor(private readonly ranges: ColourRanges) {
    this.message.dataset.testid = "range-wrong";
    const field = (end: End): HTMLInputElement => {
      const keydown = (event: Event): void => this.pressed(event as KeyboardEvent, end);
      return h("input", {
        type: "text",
        inputmode: "decimal",
        "aria-label": names[end],
        "data-testid": `range-${end}`,
        keydown,
        change: () => this.take(end),
      });
    };
    this.inputs = { low: field("low"), high: field("high") };
    const { low, high } = this.inputs;
    const submit = (event: Event): void => event.preventDefault();
    const row = h("div", { class: "range-row" }, low, h("span", {}, "to"), high, this.unit);
    const attributes = { class: "range", hidden: true, "aria-label": "Ends of the colour scale", submit };
    this.element = h("form", attributes, row, this.message);
  }

  /** Shows the fields for a mode, with the focus on one of them; hides them if they are shown. */
  toggle(end: End): void {
    this.element.hidden = !this.element.hidden;
    if (this.element.hidden) return;
    this.fill();
    this.inputs[end].focus();
    this.inputs[end].select();
  }

  /** Call at every tick. */
  update(mode: Mode, facts: Facts): void {
    const other = mode !== this.mode || facts !== this.facts;
    this.mode = mode;
    this.facts = facts;
    if (!quantityOf(mode).scale) this.element.hidden = true;
    if (other && !this.element.hidden) this.fill();
    if (this.element.hidden) return;
    const automatic = this.ranges.automaticOf(mode, facts);
    ends.forEach((end, k) => {
      const text = entryText((automatic[k] ?? 0) / sizeOf(mode));
      if (this.inputs[end].placeholder !== text) this.inputs[end].placeholder = text;
    });
  }

  private fill(): void {
    const given = this.ranges.givenOf(this.mode);
    for (const end of ends) {
      const value = given[end];
      this.inputs[end].value = value === undefined ? "" : entryText(value / sizeOf(this.mode));
      this.mark(end, "");
    }
    this.unit.textContent = scaleOf(this.mode)?.unit ?? "";
  }

  private pressed(event: KeyboardEvent, end: End): void {
    if (event.key === "Enter") {
      this.take(end);
      event.preventDefault();
    } else if (event.key === "Escape") {
      this.element.hidden = true;
      event.preventDefault();
    } else {
      return;
    }
    event.stopPropagation();
  }

  /** Takes over the text of a field, or says at the field what is wrong with it. */
  private take(end: End): void {
    const { mode } = this;
    const text = this.inputs[end].value.trim();
    const value = text === "" ? undefined : parseEntry(text) * sizeOf(mode);
    const given = { ...this.ranges.givenOf(mode), [end]: value };
    const [low, high] = this.ranges.automaticOf(mode, this.facts);
    const range = { low: given.low ?? low, high: given.high ?? high };
    const fits = range.low < range.high;
    const other = range[end === "low" ? "high" : "low"] / sizeOf(mode);
    const rule: EntryRule = { unit: scaleOf(mode)?.unit ?? "", [end === "low" ? "most" : "above"]: other };
    this.mark(end, fits ? "" : allowed(rule));
    if (fits) this.ranges.give(mode, given);
  }

  private mark(end: End, error: string): void {
    const input = this.inputs[end];
    if (error) {
      input.setAttribute("aria-invalid", "true");
      input.setAttribute("aria-describedby", this.message.id);
    } else {
      input.removeAttribute("aria-invalid");
      input.removeAttribute("aria-describedby");
    }
    setText(this.message, error && `${error}.`);
    this.message.hidden = error === "";
  }
}

function scaleOf(mode: Mode): Scale | undefined {
  return quantityOf(mode).scale;
}

function sizeOf(mode: Mode): number {
  return scaleOf(mode)?.size ?? 1;
}
