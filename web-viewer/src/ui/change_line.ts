import type { Change } from "../gen/spherule/v1/control_pb";
import { h, setText } from "./dom";

const deeds: Record<string, string> = {
  load: "Loading",
  reset: "Resetting the scene",
  spawn: "Adding spheres",
  set: "Changing the settings",
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

/** Shows the progress of a long command, with a button to cancel it. */
export class ChangeLine {
  private readonly text = h("p", {});
  private readonly bar = h("progress", { max: "1", value: "0", "aria-label": "Progress" });
  private readonly cancel: HTMLButtonElement;
  readonly element: HTMLElement;

  /** `id`: for tests. */
  constructor(cancel: () => void, id = "change") {
    this.cancel = h("button", { type: "button", "data-testid": `${id}-cancel`, click: cancel }, "Cancel");
    this.element = h(
      "section",
      { class: "steering", hidden: true, "aria-label": "Command in progress", "data-testid": id },
      h("div", { class: "row" }, this.text, this.bar, this.cancel),
    );
  }

  /** `blockedReason`: why this page may not send commands; empty if it may. */
  update(change: Pick<Change, "what" | "doing" | "share"> | undefined, blockedReason: string): void {
    this.element.hidden = change === undefined;
    if (!change) return;
    setText(this.text, changeText(change));
    this.bar.value = change.share;
    this.cancel.disabled = blockedReason !== "";
    this.cancel.title = blockedReason;
  }
}
