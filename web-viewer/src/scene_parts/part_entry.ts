import type { JsonObject, JsonValue } from "@bufbuild/protobuf";
import type { Outcome } from "../connection/link";
import { h, setText, uniqueId } from "../ui/dom";
import { sentence } from "../format";
import type { PartKind, Value } from "./part_kinds";
import { numbersOf, problemOf, withValue } from "./part_values";

/** Sends a part, or asks to remove it. Errors of the JSON are thrown. */
export interface PartActions {
  change(number: number, part: JsonValue, shown: JsonObject): Promise<Outcome>;
  remove(number: number, part: JsonObject): Promise<Outcome>;
}

/** A part of the scene in a list: its most used values in fields, all of it as text, and the faults of entries. */
export class PartEntry {
  readonly element: HTMLDetailsElement;
  private readonly summary = h("summary");
  private readonly rows = h("div", { class: "values" });
  private readonly text = h("textarea", { rows: "5", spellcheck: "false", "aria-label": "The part as JSON" });
  private readonly problem: HTMLElement;
  private part: JsonObject = {};
  private shown = ""; // the part of which the elements are made

  constructor(
    private readonly kind: PartKind,
    private readonly number: number,
    private readonly actions: PartActions,
  ) {
    const id = `${kind.id}-${number}`;
    this.problem = h("p", { class: "wrong", role: "alert", "data-testid": `${id}-wrong` });
    this.problem.hidden = true;
    this.text.dataset.testid = `${id}-text`;
    const apply = { type: "button", "data-testid": `${id}-apply`, click: () => void this.applyText() };
    const remove = { type: "button", "data-testid": `${id}-remove`, click: () => void this.remove() };
    const buttons = h("div", { class: "row" }, h("button", apply, "Apply text"), h("button", remove, "Remove"));
    const all = h("details", { class: "all" }, h("summary", {}, "As text"), this.text);
    this.element = h(
      "details",
      { class: "part", "data-testid": `${id}-entry` },
      this.summary,
      this.rows,
      all,
      buttons,
      this.problem,
    );
  }

  /** Shows a part. Entries of the user stay as long as the part does not change. */
  show(part: JsonObject): void {
    const text = JSON.stringify(part, undefined, 1);
    if (text === this.shown) return;
    this.shown = text;
    this.part = part;
    setText(this.summary, this.kind.name(part));
    this.text.value = text;
    this.rows.replaceChildren(...this.kind.values.flatMap((value) => this.rowOf(value)));
    this.tell("");
  }

  private rowOf({ path, label, text = false }: Value): HTMLElement[] {
    const present = path.reduce<JsonValue | undefined>(
      (value, key) => (value as JsonObject | undefined)?.[key],
      this.part,
    );
    if (present === undefined) return [];
    const id = uniqueId("part");
    const input = h("input", { type: "text", id, "data-testid": `${this.kind.id}-${this.number}-${path.join("-")}` });
    input.value = Array.isArray(present) ? (present as number[]).join("  ") : `${present as string | number}`;
    input.addEventListener("change", () => {
      const value = text ? input.value : numbersOf(input.value, Array.isArray(present));
      if (value === undefined)
        return this.tell(`${label}: give ${Array.isArray(present) ? "three numbers" : "a number"}.`);
      void this.send(() => this.actions.change(this.number, withValue(this.part, path, value), this.part));
    });
    return [h("div", { class: "control" }, h("label", { for: id }, label), input)];
  }

  private applyText(): Promise<void> {
    return this.send(() => this.actions.change(this.number, JSON.parse(this.text.value) as JsonValue, this.part));
  }

  private remove(): Promise<void> {
    return this.send(() => this.actions.remove(this.number, this.part));
  }

  private async send(send: () => Promise<Outcome>): Promise<void> {
    try {
      this.tell(problemOf(await send()));
    } catch (error) {
      const text = error instanceof Error ? error.message : String(error);
      this.tell(sentence(text.replace(/^.* from JSON: /, "")));
    }
  }

  private tell(problem: string): void {
    this.problem.hidden = problem === "";
    setText(this.problem, problem);
  }
}
