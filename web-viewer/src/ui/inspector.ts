import { groupOf, radiusOf } from "../model/facts";
import type { Facts } from "../model/facts";
import { leastSpeed, shownPosition, speedOf } from "../model/positions";
import type { Shown } from "../model/states";
import { h, setText } from "./dom";
import { count, figure, length, vector } from "./format";

/** Shows the selected sphere: position, speed, radius and group. */
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
