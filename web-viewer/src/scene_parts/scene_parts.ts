import type { JsonObject } from "@bufbuild/protobuf";
import type { Commands } from "../connection/commands";
import type { SceneParts } from "../gen/spherule/v1/scene_parts_pb";
import type { Facts } from "../model/facts";
import { h, setText, uniqueId } from "../ui/dom";
import { adoptStyle } from "../ui/parts";
import { PartEntry } from "./part_entry";
import { kinds } from "./part_kinds";
import type { Known, PartKind } from "./part_kinds";
import { problemOf } from "./part_values";
import style from "./scene_parts.css";

const most = 40; // parts with an entry

/** The parts of one kind, with templates for more. */
class PartList {
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "entries" });
  private readonly pick = h("span", { class: "pick" });
  private readonly select = h("select");
  private readonly problem: HTMLElement;
  private readonly more = h("p", { class: "note", hidden: true });
  private entries: PartEntry[] = [];
  private known: Known | undefined;

  constructor(
    private readonly kind: PartKind,
    private readonly commands: Commands,
  ) {
    this.problem = h("p", { class: "wrong", role: "alert", hidden: true, "data-testid": `${kind.id}-wrong` });
    const title = h("h3", { id: uniqueId("parts") }, kind.title);
    const heading = h("div", { class: "heading" }, title);
    const { add, templates } = kind;
    if (add) {
      const names = Object.keys(templates);
      const options = ["Add…", ...names].map((name) => h("option", {}, name));
      const { select } = this;
      select.dataset.testid = `${kind.id}-add`;
      select.setAttribute("aria-label", `Add: ${kind.title.toLowerCase()}`);
      select.append(...options);
      select.addEventListener("change", () => {
        const template = templates[names[select.selectedIndex - 1] ?? ""];
        select.selectedIndex = 0;
        if (template && this.known) void this.add(add(template(this.known)));
      });
      this.pick.append(select);
      heading.append(this.pick);
    }
    const attributes = { "aria-labelledby": title.id, "data-testid": `${kind.id}-list` };
    this.element = h("section", attributes, heading, this.problem, this.list, this.more);
  }

  show(known: Known): void {
    this.known = known;
    const missing = this.kind.missing?.(known) ?? "";
    this.select.disabled = missing !== "";
    this.pick.title = missing;
    const parts = this.kind.parts(known);
    while (this.entries.length < Math.min(parts.length, most)) this.entries.push(this.entryOf(this.entries.length));
    for (const { element } of this.entries.splice(parts.length)) element.remove();
    this.entries.forEach((entry, number) => entry.show(parts[number] as JsonObject));
    this.more.hidden = parts.length <= most;
    setText(this.more, `and ${parts.length - most} more`);
  }

  private entryOf(place: number): PartEntry {
    const { kind, commands } = this;
    const entry = new PartEntry(kind, place, {
      change: (number, part, shown) => commands.change(kind.one, kind.change(number, part, shown)),
      remove: (number, part) => commands.change(kind.one, kind.remove(number, part)),
    });
    this.list.append(entry.element);
    return entry;
  }

  private async add(command: Parameters<Commands["change"]>[1]): Promise<void> {
    const problem = problemOf(await this.commands.change(this.kind.one, command));
    this.problem.hidden = problem === "";
    setText(this.problem, problem);
  }
}

/** Lists of the fields, emitters, materials and groups of the scene, in which the user changes them. */
export class PartLists {
  readonly element: HTMLFieldSetElement;
  private readonly lists: PartList[];

  constructor(commands: Commands) {
    adoptStyle(style);
    this.lists = kinds.map((kind) => new PartList(kind, commands));
    const attributes = { class: "scene-parts", "data-testid": "scene-parts" };
    this.element = h("fieldset", attributes, ...this.lists.map(({ element }) => element));
  }

  /** `blockedReason`: why the user may not change anything; empty if they may. */
  show(parts: SceneParts, facts: Facts, blockedReason: string): void {
    this.element.disabled = blockedReason !== "";
    this.element.title = blockedReason;
    for (const list of this.lists) list.show({ parts, facts });
  }
}
