import { effect } from "@preact/signals-core";
import type { Outcome } from "../connection/link";
import { live } from "./bindings";
import { h, setText, uniqueId } from "./dom";
import { entryError, entryText, parseEntry } from "./entry";
import type { EntryRule } from "./entry";
import { refusalText } from "./refusals";

/** Takes a value that the user gives: the page keeps it (`set`), or asks the server to apply it (`send`). */
export type Taker<Value> = { set(value: Value): void } | { send(value: Value): Promise<Outcome> };

export type NumberOptions = Taker<number> & {
  /** The present value: state that the field follows. */
  get(): number;
  /** The numbers that are allowed, asked at each entry. */
  rule(): EntryRule;
  slider?: [low: number, high: number, step: number]; // a slider for a part of the allowed numbers
  whileDragged?: boolean; // the value follows the slider while the user drags it
};

/**
 * A number field that answers a wrong entry at the field. It keeps the user's text, marks it, says what is allowed, and
 * changes no value. Escape restores the last value. While the user types or drags, changes of the value do not move it.
 */
export class NumberField {
  readonly input: HTMLInputElement;
  readonly slider: HTMLInputElement | undefined;
  readonly message: HTMLElement; // says what is wrong
  private typed = false; // the text was changed since it was taken over
  private taken = ""; // the last text that was taken over
  private wrong = false;
  private refused = false; // by the server: the value may be sent again
  private dragged = false; // the user holds the slider
  private sent: number | undefined; // the server has not answered yet

  /** `id`: of the input, for tests. */
  constructor(
    id: string,
    private readonly options: NumberOptions,
    disabled: () => boolean,
  ) {
    const attributes = { type: "text", inputmode: "decimal", autocomplete: "off", "data-testid": id };
    this.input = live(h("input", attributes), { disabled });
    this.message = h("p", { class: "wrong", id: uniqueId("entry"), role: "alert", hidden: true });
    this.message.dataset.testid = `${id}-wrong`;
    this.input.addEventListener("input", () => this.edited());
    this.input.addEventListener("keydown", (event) => this.pressed(event));
    this.input.addEventListener("blur", () => {
      if (this.take()) this.show();
    });
    if (options.slider) this.slider = live(this.createSlider(options.slider), { disabled });
    effect(() => {
      if (disabled()) this.dragged = false; // a disabled slider has no further events
    });
    effect(() => {
      options.get();
      this.sent = undefined;
      this.show();
    });
  }

  /** The value that is shown, or the last one, if the present entry is wrong. */
  get value(): number {
    return this.sent ?? this.options.get();
  }

  /** Marks the last entry as refused by the server, unless there is a newer one. `text`: what to do. */
  refuse(text: string): void {
    if (this.typed) return;
    if (this.taken) this.input.value = this.taken; // a value that came meanwhile has replaced it
    this.mark(text);
    this.refused = true;
  }

  /** Whether the entry is right, or was refused by the server alone. If not, moves the focus to it. */
  check(): boolean {
    if (this.refused || this.take()) return true;
    this.input.focus();
    return false;
  }

  /** Shows the present value instead of a wrong entry. */
  restore(): void {
    this.typed = false;
    this.mark("");
    this.write(this.value);
  }

  private createSlider([min, max, step]: [number, number, number]): HTMLInputElement {
    const attributes = { type: "range", min: String(min), max: String(max), step: String(step) };
    const slider = h("input", { ...attributes, "data-testid": `${this.input.dataset.testid ?? ""}-slider` });
    slider.addEventListener("input", () => {
      this.dragged = true;
      this.typed = false;
      this.mark("");
      this.write(slider.valueAsNumber);
      if (this.options.whileDragged) void this.give(slider.valueAsNumber);
    });
    slider.addEventListener("change", () => {
      this.dragged = false;
      this.taken = this.input.value;
      void this.give(slider.valueAsNumber);
    });
    // There is no change event if the slider is released where it was.
    for (const end of ["pointerup", "pointercancel", "keyup", "blur"]) {
      slider.addEventListener(end, () => (this.dragged = false));
    }
    return slider;
  }

  private show(): void {
    if (this.dragged || this.wrong || document.activeElement === this.input) return;
    this.write(this.value);
  }

  private write(value: number): void {
    const { input, slider } = this;
    const text = entryText(value);
    if (input.value !== text) input.value = text;
    if (!slider) return;
    const [low, high] = this.options.slider as [number, number, number];
    if (!this.dragged) slider.valueAsNumber = value;
    slider.style.setProperty("--share", String(Math.min(1, Math.max(0, (value - low) / (high - low)))));
  }

  private async give(value: number): Promise<void> {
    if ("set" in this.options) return this.options.set(value);
    this.sent = value;
    this.write(value);
    const outcome = await this.options.send(value);
    if (outcome.case === "refused" && outcome.value.field) this.refuse(refusalText(outcome.value));
    if (outcome.case === "applied") return;
    this.sent = undefined;
    this.show();
  }

  private edited(): void {
    this.typed = true;
    this.mark(this.wrong ? entryError(parseEntry(this.input.value), this.options.rule()) : "");
  }

  private pressed(event: KeyboardEvent): void {
    if (event.key === "Escape" && this.input.dataset.edited !== undefined) {
      this.restore();
      event.preventDefault();
    } else if (event.key === "Enter" && this.take()) {
      this.input.blur();
    } else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      event.preventDefault();
      if (this.take()) this.move((event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : 1));
    }
  }

  /** Changes the value by some steps. */
  private move(steps: number): void {
    const { least = -Infinity, above = -Infinity, most = Infinity, whole } = this.options.rule();
    const now = parseEntry(this.input.value);
    const size = whole ? 1 : (this.options.slider?.[2] ?? 10 ** (Math.floor(Math.log10(Math.abs(now) || 1)) - 1));
    const next = Math.min(most, Math.max(least, Number((now + steps * size).toPrecision(12))));
    if (next === now || !(next > above)) return;
    this.write(next);
    this.taken = this.input.value;
    void this.give(next);
  }

  /** Takes over the text as the value. Returns false if it is wrong. */
  private take(): boolean {
    if (!this.typed) return !this.wrong;
    const value = parseEntry(this.input.value);
    const error = entryError(value, this.options.rule());
    this.typed = error !== "";
    this.mark(error);
    if (error) return false;
    this.taken = this.input.value;
    void this.give(value);
    return true;
  }

  private mark(error: string): void {
    this.wrong = error !== "";
    this.refused = false;
    this.input.toggleAttribute("data-edited", this.typed || this.wrong); // Escape restores the value
    setText(this.message, error && error.replace(/\.?$/, "."));
    this.message.hidden = !this.wrong;
    this.input.setAttribute("aria-invalid", String(this.wrong));
    if (this.wrong) this.input.setAttribute("aria-describedby", this.message.id);
    else this.input.removeAttribute("aria-describedby");
  }
}
