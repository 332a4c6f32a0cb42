import { count, vector } from "../format";
import type { Facts } from "../model/facts";
import { shownPosition } from "../model/positions";
import { modes, quantityOf } from "../model/quantities";
import type { Shown } from "../model/states";
import { h, setText } from "./dom";

/** Shows the selected sphere: its position and its quantities. */
export class Inspector {
  selected: number | undefined;
  private readonly name = h("h2", { "data-testid": "inspected" });
  private readonly text = h("p");
  readonly element: HTMLElement;

  constructor() {
    const deselect = { type: "button", title: "Deselect (Esc)", click: () => this.select(undefined) };
    this.element = h(
      "section",
      { class: "inspector", hidden: true, "aria-label": "Selected sphere" },
      h("div", { class: "row" }, this.name, h("button", deselect, "×")),
      this.text,
    );
  }

  select(id: number | undefined): void {
    this.selected = id;
  }

  update(facts: Facts | undefined, shown: Shown | undefined): void {
    const id = this.selected;
    const known = facts && shown && id !== undefined && id < shown.to.count;
    this.element.hidden = !known;
    if (!known) return;
    const lines = modes.flatMap((mode) => quantityOf(mode).describe?.(facts, shown, id) ?? []);
    setText(this.name, `Sphere ${count(id)}`);
    setText(this.text, [`at ${vector(shownPosition(facts, shown, id), 3)} m`, ...lines].join("\n"));
  }
}
