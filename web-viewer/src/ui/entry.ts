import type { NumberController } from "lil-gui";
import { count, figure } from "../format";
import { h, setText, uniqueId } from "./dom";

/** The numbers that a field accepts. */
export interface EntryRule {
  unit: string; // as in "m/s²"; empty: none
  whole?: boolean; // whole numbers only
  above?: number; // larger than this
  least?: number;
  most?: number;
}

/** Reads a number as people write it; NaN if it is none. */
export function parseEntry(text: string): number {
  const plain = text
    .trim()
    .replace(/^−/, "-")
    .replace(/e−/i, "e-")
    .replace(/(\d)[\u202f\u00a0 ](?=\d{3}(\D|$))/g, "$1");
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(plain) ? Number(plain) : NaN;
}

/** Says what is allowed; empty if the value is. */
export function entryError(value: number, rule: EntryRule): string {
  const { above, least, most, whole } = rule;
  const right =
    Number.isFinite(value) &&
    (!whole || Number.isInteger(value)) &&
    !(above !== undefined && value <= above) &&
    !(least !== undefined && value < least) &&
    !(most !== undefined && value > most);
  return right ? "" : allowed(rule);
}

/** The allowed numbers in words, as in "Give a number from 0 to 100 m". */
export function allowed({ unit, whole, above, least, most }: EntryRule): string {
  const show = (value: number): string => (whole ? count(value) : figure(value));
  const kind = `Give a ${whole ? "whole number" : "number"}`;
  const end = unit ? `\u00a0${unit}` : "";
  if (above !== undefined && most !== undefined) return `${kind} above ${show(above)} and up to ${show(most)}${end}`;
  if (above !== undefined) return `${kind} above ${show(above)}${end}`;
  if (least !== undefined && most !== undefined) return `${kind} from ${show(least)} to ${show(most)}${end}`;
  if (most !== undefined) return `${kind} of at most ${show(most)}${end}`;
  if (least !== undefined) return `${kind} of at least ${show(least)}${end}`;
  return `${kind}${unit ? ` in ${unit}` : ""}`;
}

/** The text of a value in a field: at most 6 digits, and no digits that say nothing. */
export function entryText(value: number): string {
  return String(Number(value.toPrecision(6)));
}

/**
 * A number field of the panel that answers a wrong entry at the field. It keeps the user's text, marks it, says below
 * it what is allowed, and changes no value. Escape restores the last value.
 */
export class Entry {
  private readonly message = h("p", { class: "wrong", id: uniqueId("entry"), role: "alert", hidden: true });
  private readonly input: HTMLInputElement;
  private typed = false; // the text was changed since it was taken over
  private taken = ""; // the last text that was taken over
  private wrong = false;
  private valueThen: unknown; // when the entry was found wrong
  private refused = false; // by the server: the value may be sent again

  /** `rule` is asked at each entry; `below`: the element below which the message stands, else the controller. */
  constructor(
    private readonly controller: NumberController,
    private readonly rule: () => EntryRule,
    below: HTMLElement = controller.domElement,
  ) {
    const { $input, domElement } = controller;
    this.input = $input;
    this.input.type = "text"; // a number field would hide the text that is no number
    this.input.inputMode = "decimal";
    this.message.dataset.testid = `${domElement.dataset.control}-wrong`;
    below.after(this.message);
    // These run before lil-gui's listeners, which take the number at the beginning of any text.
    domElement.addEventListener("input", (event) => this.edited(event), true);
    domElement.addEventListener("keydown", (event) => this.pressed(event), true);
    domElement.addEventListener("blur", () => this.take(), true);
    const show = controller.updateDisplay.bind(controller);
    controller.updateDisplay = () => {
      const text = this.input.value;
      show();
      const dragged = document.body.classList.contains("lil-dragging") && controller.getValue() !== this.valueThen;
      if (this.wrong && dragged) this.mark("");
      const kept = this.wrong || document.activeElement === this.input;
      this.input.value = kept ? text : entryText(Number(controller.getValue()));
      return controller;
    };
    controller.updateDisplay();
  }

  /** Marks the last entry as refused by the server, unless there is a newer one. `text`: what to do. */
  refuse(text: string): void {
    if (this.typed) return;
    if (this.taken) this.input.value = this.taken; // settings that came meanwhile have replaced it
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
    this.input.value = entryText(Number(this.controller.getValue()));
  }

  private edited(event: Event): void {
    if (event.target !== this.input) return;
    event.stopPropagation();
    this.typed = true;
    this.mark(this.wrong ? entryError(parseEntry(this.input.value), this.rule()) : "");
  }

  private pressed(event: KeyboardEvent): void {
    if (event.target !== this.input) return;
    if (event.key === "Escape" && this.input.dataset.edited !== undefined) {
      this.restore();
      event.preventDefault();
    } else if (event.key === "Enter" && !this.take()) {
      event.stopPropagation(); // the field keeps the focus
    } else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      if (!this.take()) event.stopPropagation(); // else lil-gui goes on from this value
    }
  }

  /** Takes over the text as the value. Returns false if it is wrong. */
  private take(): boolean {
    if (!this.typed) return !this.wrong;
    const value = parseEntry(this.input.value);
    const error = entryError(value, this.rule());
    this.typed = error !== "";
    this.mark(error);
    if (error) return false;
    this.taken = this.input.value;
    this.controller.setValue(value);
    return true;
  }

  private mark(error: string): void {
    if (error && !this.wrong) this.valueThen = this.controller.getValue();
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
