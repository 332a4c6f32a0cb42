import type { Outcome } from "../connection/link";
import { count, vector } from "../format";
import type { Facts } from "../model/facts";
import { shownPosition } from "../model/positions";
import { modes, quantityOf } from "../model/quantities";
import { Selection } from "../model/selection";
import type { Shown } from "../model/states";
import { h, setText, setTitle } from "./dom";

/** Shows the selected sphere: its position and its quantities. */
export class Inspector {
  readonly selection = new Selection();
  private readonly name = h("h2", { "data-testid": "inspected" });
  private readonly lines = h("div");
  private readonly removal: HTMLButtonElement;
  private readonly following: HTMLButtonElement;
  private removing = false; // the command has no result yet
  readonly element: HTMLElement;

  /** `remove` is given the id of the sphere to remove. */
  constructor(private readonly remove: (id: number) => Promise<Outcome>) {
    const deselect = {
      type: "button",
      class: "close",
      title: "Deselect (Esc)",
      "aria-label": "Deselect",
      click: () => this.selection.clear(),
    };
    const click = (): void => void this.removeSelected();
    this.removal = h("button", { type: "button", "data-testid": "remove", click }, "Remove");
    const follow = (): void => this.toggleFollowed();
    this.following = h("button", { type: "button", "data-testid": "follow", click: follow }, "Follow");
    this.following.title = "The camera follows the sphere (G)";
    this.element = h(
      "section",
      { class: "inspector", hidden: true, "aria-label": "Selected sphere" },
      h("div", { class: "row" }, this.name, h("button", deselect, "×")),
      this.lines,
      h("div", { class: "actions" }, this.following, this.removal),
    );
  }

  /** The camera follows the selected sphere, or no longer does. */
  toggleFollowed(): void {
    this.selection.followed = this.selection.id !== undefined && !this.selection.followed;
  }

  async removeSelected(): Promise<void> {
    const { id } = this.selection;
    if (id === undefined || this.removing) return;
    this.removing = true;
    const outcome = await this.remove(id);
    this.removing = false;
    if (outcome.case === "applied" && this.selection.id === id) this.selection.clear();
  }

  /** `playing`: the server plays a recording. `blockedReason`: why the user may not remove it; empty if they may. */
  update(facts: Facts | undefined, shown: Shown | undefined, playing: boolean, blockedReason: string): void {
    const { id, place } = this.selection;
    const known = facts && shown && id !== undefined && place !== undefined && place < shown.to.count;
    this.element.hidden = !known;
    if (!known) return;
    const lines = modes.flatMap((mode) => quantityOf(mode).describe?.(facts, shown, place) ?? []);
    setText(this.name, `Sphere ${count(id)}`);
    this.show([`at ${vector(shownPosition(facts, shown, place), 3)} m`, ...lines]);
    this.following.setAttribute("aria-pressed", String(this.selection.followed));
    this.removal.hidden = playing;
    this.removal.disabled = blockedReason !== "";
    this.removal.title = blockedReason || "Remove the sphere (Del)";
  }

  /** Each text has a line of its own, whatever it contains. */
  private show(texts: string[]): void {
    while (this.lines.childElementCount > texts.length) this.lines.lastElementChild?.remove();
    texts.forEach((text, i) => {
      const line = this.lines.children[i] ?? this.lines.appendChild(h("p"));
      if (!(line instanceof HTMLElement)) return;
      setText(line, text);
      setTitle(line, text);
    });
  }
}
