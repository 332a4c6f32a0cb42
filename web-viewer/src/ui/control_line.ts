import type { ControlState } from "../model/control_state";
import { nameText } from "../model/names";
import type { DisplayName } from "../model/names";
import { h } from "./dom";

export interface ControlActions {
  request(): void;
  withdraw(): void;
  handOver(session: bigint): void;
  release(): void;
  keep(): void;
}

const maxRows = 3; // of requests

/** Shows which client has control and which ones request it, where one client at a time has it. */
export class ControlLine {
  readonly element = h("section", {
    class: "steering",
    hidden: true,
    "aria-label": "Control of the simulation",
    "aria-live": "polite",
    "data-testid": "control",
    "data-state": "unrestricted",
  });

  constructor(private readonly actions: ControlActions) {}

  show(state: ControlState): void {
    const rows = this.rowsFor(state);
    const focused = this.element.contains(document.activeElement);
    this.element.hidden = rows.length === 0;
    this.element.dataset.state = state.kind;
    this.element.classList.toggle("asked", state.kind === "mine" && state.asking.length > 0);
    this.element.replaceChildren(...rows);
    if (focused) this.element.querySelector("button")?.focus(); // the button that had the focus was replaced
  }

  private rowsFor(state: ControlState): HTMLElement[] {
    switch (state.kind) {
      case "mine":
        return this.rowsOfHolder(state.asking);
      case "taken": {
        const holder = nameElement(state.holder);
        if (!state.asked) {
          return [row([holder, " has control"], button("control-ask", "Request control", this.actions.request))];
        }
        const text = ["Requested", optional("; waiting for"), " ", holder];
        return [row(text, button("control-withdraw", "Withdraw", this.actions.withdraw))];
      }
      default:
        return [];
    }
  }

  /** Requests come first, so that the last line, with the buttons of this page, stays in its place. */
  private rowsOfHolder(asking: DisplayName[]): HTMLElement[] {
    const rows = asking.slice(0, maxRows).map((client) => {
      const handOver = button("control-hand-over", "Hand over", () => this.actions.handOver(client.session));
      handOver.setAttribute("aria-label", `Hand over to ${nameText(client)}`);
      return row([nameElement(client), " requests", optional(" control")], handOver);
    });
    if (asking.length > maxRows) rows.push(row([`and ${asking.length - maxRows} more`]));
    const release = button("control-release", "Release", this.actions.release);
    const keep = asking.length > 0 ? [button("control-keep", "Keep", this.actions.keep)] : [];
    return [...rows, row(["You have control"], ...keep, release)];
  }
}

function row(text: (Node | string)[], ...buttons: HTMLElement[]): HTMLElement {
  return h("div", { class: "row" }, h("p", {}, ...text), ...buttons);
}

/** A name, isolated from the direction of the text around it. Its number stays visible if the name is cut. */
function nameElement(client: DisplayName): HTMLElement {
  const number = client.number ? [h("i", {}, client.number)] : [];
  return h("b", { title: nameText(client) }, h("bdi", {}, client.name), ...number);
}

/** Text that is hidden where there is little room. */
function optional(text: string): HTMLElement {
  return h("span", { class: "more" }, text);
}

function button(id: string, text: string, click: () => void): HTMLButtonElement {
  return h("button", { type: "button", "data-testid": id, click }, text);
}
