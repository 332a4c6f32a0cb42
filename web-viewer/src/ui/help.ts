import { h } from "./dom";
import type { Key } from "./keys";

const gestures = (playing: boolean): [string, string][] => [
  ["drag · one finger", "orbit"],
  ["right or shift + drag · two fingers", "move"],
  ["wheel · pinch", "zoom to that place"],
  ["click · tap", playing ? "select a sphere" : "select a sphere, or push it in push mode"],
];

const onTimeline: [string, string] = ["Timeline", "← → a frame, ↑ ↓ a second, Home, End"];

/** Keys and gestures, over the page. */
export class Help {
  readonly element: HTMLDialogElement = h("dialog", {
    class: "help",
    "data-testid": "help-overlay",
    "aria-label": "Keys and gestures",
    click: () => this.element.close(),
  });

  describe(keys: Key[], playing: boolean): void {
    const list = (rows: [string, string][]): HTMLElement =>
      h("dl", {}, ...rows.flatMap(([term, text]) => [h("dt", {}, term), h("dd", {}, text)]));
    this.element.replaceChildren(
      h("h2", {}, "Gestures"),
      list(gestures(playing)),
      h("h2", {}, "Keys"),
      list([...keys.filter((key) => key.shown).map((key): [string, string] => [key.shown, key.says]), ...(playing ? [onTimeline] : [])]),
    );
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}
