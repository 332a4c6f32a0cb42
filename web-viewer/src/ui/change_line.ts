import type { Change } from "../gen/spherule/v1/control_pb";
import { h, setText } from "./dom";

/** A command that takes long: what the server does for it, how far that has come, and the way to end it. */
export class ChangeLine {
  private readonly words = h("p", {});
  private readonly bar = h("progress", { max: "1", value: "0", "aria-label": "Progress" });
  private readonly cancel: HTMLButtonElement;
  readonly element: HTMLElement;

  constructor(cancel: () => void) {
    this.cancel = h("button", { type: "button", "data-testid": "change-cancel", click: cancel }, "Cancel");
    const row = h("div", { class: "row" }, this.words, this.bar, this.cancel);
    this.element = h("section", { class: "steering", hidden: true, "aria-label": "Under way", "data-testid": "change" }, row);
  }

  /** `why`: what keeps this page from commanding; empty: nothing does. */
  update(change: Change | undefined, why: string): void {
    this.element.hidden = change === undefined;
    if (!change) return;
    setText(this.words, `${change.what}: ${change.doing}, ${Math.floor(100 * change.share)} %`);
    this.bar.value = change.share;
    this.cancel.disabled = why !== "";
    this.cancel.title = why;
  }
}
