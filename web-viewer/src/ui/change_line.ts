import type { Change } from "../gen/spherule/v1/control_pb";
import { live, liveText } from "./bindings";
import { h } from "./dom";

const deeds: Record<string, string> = {
  load: "Loading",
  reset: "Resetting the scene",
  spawn: "Adding spheres",
  set: "Changing the settings",
  add_field: "Adding a field",
  add_emitter: "Adding an emitter",
  step: "Stepping",
  picture: "Drawing the picture",
};

/** The command with its present work and the completed part of it, as in "Loading box-50k: placing spheres, 34 %". */
export function changeText({ what, doing, share }: Pick<Change, "what" | "doing" | "share">): string {
  const [name = "", ...rest] = what.split(" ");
  const deed = [deeds[name] ?? name, ...rest].join(" ");
  const work = doing && doing !== "stepping" ? `${doing}, ` : "";
  return `${deed}: ${work}${Math.floor(100 * Math.min(1, Math.max(0, share)))}\u00a0%`;
}

type Work = Pick<Change, "what" | "doing" | "share">;

/** Shows the progress of long work, with a button to cancel it. */
export class ChangeLine {
  readonly element: HTMLElement;

  /**
   * `work`: undefined if there is none. `blocked`: why the user may not cancel it; empty if they may. `id`: for tests.
   */
  constructor(work: () => Work | undefined, blocked: () => string, cancel: () => void, id = "change") {
    const bar = h("progress", { max: "1", value: "0", "aria-label": "Progress" });
    const button = h("button", { type: "button", "data-testid": `${id}-cancel`, click: cancel }, "Cancel");
    live(bar, { value: () => work()?.share ?? 0 });
    live(button, { disabled: () => blocked() !== "", title: blocked });
    const text = liveText(() => {
      const present = work();
      return present ? changeText(present) : "";
    });
    const attributes = { class: "steering", "aria-label": "Command in progress", "data-testid": id };
    const row = h("div", { class: "row" }, h("p", {}, text), bar, button);
    this.element = live(h("section", attributes, row), { hidden: () => !work() });
  }
}
