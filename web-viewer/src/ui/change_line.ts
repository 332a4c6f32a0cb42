import type { Change } from "../gen/spherule/v1/control_pb";
import { h, setText } from "./dom";

/** Shows the progress of a long command, with a button to cancel it. */
export class ChangeLine {
  private readonly text = h("p", {});
  private readonly bar = h("progress", { max: "1", value: "0", "aria-label": "Progress" });
  private readonly cancel: HTMLButtonElement;
  readonly element: HTMLElement;

  constructor(cancel: () => void) {
    this.cancel = h("button", { type: "button", "data-testid": "change-cancel", click: cancel }, "Cancel");
    this.element = h(
      "section",
      { class: "steering", hidden: true, "aria-label": "Command in progress", "data-testid": "change" },
      h("div", { class: "row" }, this.text, this.bar, this.cancel),
    );
  }

  /** `blockedReason`: why this page may not send commands; empty if it may. */
  update(change: Change | undefined, blockedReason: string): void {
    this.element.hidden = change === undefined;
    if (!change) return;
    setText(this.text, `${change.what}: ${change.doing}, ${Math.floor(100 * change.share)} %`);
    this.bar.value = change.share;
    this.cancel.disabled = blockedReason !== "";
    this.cancel.title = blockedReason;
  }
}
