import type GUI from "lil-gui";
import { css } from "../colour/rgb";
import { count } from "../format";
import { sides } from "../model/cut";
import type { Cut } from "../model/cut";
import type { Facts } from "../model/facts";
import type { Group } from "../model/population";
import { tag } from "./controllers";
import { h, setText } from "./dom";

const sideNames = Object.fromEntries(sides.map((side) => [side === "none" ? "nothing" : side, side]));
const most = 40; // groups with a row

interface Row {
  element: HTMLElement;
  box: HTMLInputElement;
  figure: HTMLElement;
}

/** The folder of the panel that chooses what images leave out: groups, and all beyond a plane. */
export class CutFolder {
  private readonly at = { percent: 50 };
  private readonly list = h("ul", { class: "groups", "data-testid": "groups", "aria-label": "Groups that are shown" });
  private readonly more = h("p", { class: "note", hidden: true });
  private rows: Row[] = [];
  private known: readonly Group[] = [];
  private length = 0; // of `known` when the rows were made

  constructor(
    private readonly folder: GUI,
    private readonly cut: Cut,
  ) {
    const side = tag("cut-side", folder.add(cut, "side", sideNames).name("Cut across"));
    side.domElement.title = "Shows only what lies on one side of a plane across this axis";
    const at = folder.add(this.at, "percent", 0, 100, 0.5).name("Cut at, %");
    tag("cut-at", at).domElement.title = "Place of the plane, from the low end of the bounds to their high end";
    at.onChange((percent: number) => (cut.share = percent / 100));
    tag("cut-flipped", folder.add(cut, "flipped", { "low side": false, "high side": true }).name("Shown"));
    folder.$children.append(this.list, this.more);
  }

  /** Call when another scene is shown. */
  reset(): void {
    this.cut.reset();
    this.at.percent = 50;
    for (const controller of this.folder.controllers) controller.updateDisplay();
  }

  update({ population: { groups } }: Facts): void {
    if (groups !== this.known || groups.length !== this.length) this.build(groups);
    this.rows.forEach(({ box, figure, element }, number) => {
      const group = groups[number];
      if (!group) return;
      setText(figure, count(group.count));
      box.checked = !this.cut.hidden.has(number);
      element.classList.toggle("gone", group.count === 0);
    });
  }

  private build(groups: readonly Group[]): void {
    this.known = groups;
    this.length = groups.length;
    this.rows = groups.slice(0, most).map((group, number) => this.rowOf(group, number));
    this.list.replaceChildren(...this.rows.map(({ element }) => element));
    this.more.hidden = groups.length <= most;
    setText(this.more, `and ${count(groups.length - this.rows.length)} more`);
  }

  private rowOf({ name, colour }: Group, number: number): Row {
    const toggle = (): void => this.cut.show(number, box.checked);
    const box = h("input", { type: "checkbox", "data-testid": `group-${number}`, change: toggle });
    const isolate = (): void => this.cut.isolate(number, this.length);
    const only = { type: "button", title: `Show only ${name}, or everything`, "aria-label": `Only ${name}` };
    const figure = h("b");
    const swatch = h("i", { style: `background: ${css(colour)}` });
    const label = h("label", { class: "swatch" }, box, swatch, h("bdi", { title: name }, name), figure);
    return { element: h("li", {}, label, h("button", { ...only, click: isolate }, "only")), box, figure };
  }
}
