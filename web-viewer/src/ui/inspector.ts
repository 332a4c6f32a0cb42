import { groupOf, radiusOf } from "../scene/facts";
import type { Facts } from "../scene/facts";
import { leastSpeed, shownPosition, speedOf } from "../scene/positions";
import type { Shown } from "../scene/states";
import { h, setText } from "./dom";
import { count, figure, length, vector } from "./format";

/** What is known of the sphere that was clicked. */
export class Inspector {
  selected: number | undefined;
  private readonly name = h("h2", { "data-testid": "inspected" });
  private readonly text = h("p");
  readonly element: HTMLElement;

  constructor() {
    const close = h("button", { type: "button", title: "Forget this sphere (Esc)", click: () => this.select(undefined) }, "×");
    this.element = h("section", { class: "inspector", hidden: true, "aria-label": "Selected sphere" }, h("div", { class: "row" }, this.name, close), this.text);
  }

  select(id: number | undefined): void {
    this.selected = id;
  }

  update(facts: Facts | undefined, shown: Shown | undefined): void {
    const id = this.selected;
    const known = facts && shown && id !== undefined && id < shown.to.count;
    this.element.hidden = !known;
    if (!known) return;
    const group = groupOf(facts, id);
    const least = leastSpeed(shown.from, shown.to);
    const speed = speedOf(shown.from, shown.to, id);
    setText(this.name, `Sphere ${count(id)}`);
    setText(
      this.text,
      [
        `at ${vector(shownPosition(facts, shown, id), 3)} m`,
        speed < least ? `under ${figure(least)} m/s` : `${figure(speed)} m/s`,
        `radius ${length(radiusOf(facts, id))}${group ? `, ${group.name}` : ""}`,
      ].join("\n"),
    );
  }
}
