import { wordsFor } from "../scene/names";
import type { Named } from "../scene/names";
import type { Standing } from "../scene/standing";
import { h } from "./dom";

export interface ControlActions {
  ask(): void;
  withdraw(): void;
  give(session: bigint): void;
  release(): void;
  keep(): void;
}

const most = 3; // who ask, in so many lines

/** Who has the controls, where one has them at a time, and who would like to. */
export class ControlLine {
  readonly element = h("section", { class: "steering", hidden: true, "aria-label": "Who has the controls", "aria-live": "polite", "data-testid": "control" });

  constructor(private readonly act: ControlActions) {}

  show(standing: Standing): void {
    const rows = this.rowsFor(standing);
    const focused = this.element.contains(document.activeElement);
    this.element.hidden = rows.length === 0;
    this.element.classList.toggle("asked", standing.kind === "mine" && standing.asking.length > 0);
    this.element.replaceChildren(...rows);
    if (focused) this.element.querySelector("button")?.focus(); // it was on a button that is no longer there
  }

  private rowsFor(standing: Standing): HTMLElement[] {
    switch (standing.kind) {
      case "mine":
        return this.mine(standing.asking);
      case "taken": {
        const { holder, asked } = standing;
        const words = asked ? ["Asked", more("; waiting for"), " ", named(holder)] : [named(holder), " has the controls"];
        const act = asked ? button("control-withdraw", "Withdraw", this.act.withdraw) : button("control-ask", "Ask for them", this.act.ask);
        return [row(words, act)];
      }
      default:
        return [];
    }
  }

  /** Who ask stand above, so that the last line stays where it is under the hand. */
  private mine(asking: Named[]): HTMLElement[] {
    const rows = asking.slice(0, most).map((person) => {
      const give = button("control-hand-over", "Hand over", () => this.act.give(person.session));
      give.setAttribute("aria-label", `Hand over to ${wordsFor(person)}`);
      return row([named(person), " asks", more(" for the controls")], give);
    });
    if (asking.length > most) rows.push(row([`and ${asking.length - most} more`]));
    const release = button("control-release", "Release", this.act.release);
    const keep = asking.length > 0 ? [button("control-keep", "Keep", this.act.keep)] : [];
    return [...rows, row(["You have the controls"], ...keep, release)];
  }
}

function row(words: (Node | string)[], ...buttons: HTMLElement[]): HTMLElement {
  return h("div", { class: "row" }, h("p", {}, ...words), ...buttons);
}

/** As text, whatever it is, that does not turn what stands around it; the number is seen even where the name is cut. */
function named(person: Named): HTMLElement {
  const number = person.number ? [h("i", {}, person.number)] : [];
  return h("b", { title: wordsFor(person) }, h("bdi", {}, person.name), ...number);
}

/** For where there is room. */
function more(words: string): HTMLElement {
  return h("span", { class: "more" }, words);
}

function button(id: string, text: string, click: () => void): HTMLButtonElement {
  return h("button", { type: "button", "data-testid": id, click }, text);
}
