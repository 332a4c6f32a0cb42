import { effect } from "@preact/signals-core";
import { css } from "../colour/rgb";
import { count } from "../format";
import { sides } from "../model/cut";
import type { Cut, Side } from "../model/cut";
import type { Facts } from "../model/facts";
import type { Group } from "../model/population";
import type { Session } from "../model/session";
import { h, setText } from "./dom";
import { Folder } from "./folder";

const sideNames: Record<string, Side> = Object.fromEntries(
  sides.map((side) => [side === "none" ? "nothing" : side, side]),
);
const shownSides = { "low side": false, "high side": true };
const most = 40; // groups with a row

interface Row {
  element: HTMLElement;
  box: HTMLInputElement;
  figure: HTMLElement;
}

/** The folder of the panel that chooses what images leave out: groups, and all beyond a plane. */
export class CutFolder {
  readonly folder = new Folder("Show", { folded: true });
  private readonly list = h("ul", { class: "groups", "data-testid": "groups", "aria-label": "Groups that are shown" });
  private readonly more = h("p", { class: "note", hidden: true });
  private rows: Row[] = [];
  private known: readonly Group[] = [];
  private length = 0; // of `known` when the rows were made

  constructor(
    session: Session,
    private readonly cut: Cut,
  ) {
    const { folder } = this;
    folder.choice("cut-side", "Cut across", {
      title: "Shows only what lies on one side of a plane across this axis",
      options: sideNames,
      get: () => cut.side,
      set: (side) => (cut.side = side),
    });
    folder.number("cut-at", "Cut at, %", {
      title: "Place of the plane, from the low end of the bounds to their high end",
      get: () => 100 * cut.share,
      set: (percent) => (cut.share = percent / 100),
      rule: () => ({ unit: "%", least: 0, most: 100 }),
      slider: [0, 100, 0.5],
      whileDragged: true,
    });
    folder.choice("cut-flipped", "Shown", {
      options: shownSides,
      get: () => cut.flipped,
      set: (flipped) => (cut.flipped = flipped),
    });
    folder.body.append(this.list, this.more);
    effect(() => {
      if (session.spheres !== undefined && session.facts) this.show(session.facts); // follows the counts of groups
    });
  }

  private show({ population: { groups } }: Facts): void {
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
