import { h } from "./dom";
import type { CharacterKeys, Key } from "./keys";

const gestures = (playing: boolean): [string, string][] => [
  ["drag · one finger", "orbit"],
  ["right or shift + drag · two fingers", "pan"],
  ["wheel · pinch", "zoom to the pointer"],
  ["click · tap", playing ? "select a sphere" : "select a sphere, or use the chosen tool"],
];

const onTimeline: [string, string] = ["Timeline", "← → one frame, ↑ ↓ one second, Home, End"];

/** A dialog that lists keys and gestures. A click closes it. */
export class Help {
  readonly element: HTMLDialogElement = h("dialog", {
    class: "help",
    "data-testid": "help-overlay",
    "aria-label": "Keys and gestures",
    tabindex: "-1",
    click: (event: Event) => {
      if (!(event.target instanceof Element && event.target.closest("label"))) this.element.close();
    },
  });
  private readonly choice: HTMLElement;

  constructor(characters: CharacterKeys) {
    const box = h("input", {
      type: "checkbox",
      "data-testid": "character-keys",
      change: () => (characters.enabled = box.checked),
    });
    box.checked = characters.enabled;
    this.choice = h("label", {}, box, "Keys of one character act, such as R and +");
  }

  describe(keys: Key[], playing: boolean): void {
    const list = (rows: [string, string][]): HTMLElement =>
      h("dl", {}, ...rows.flatMap(([term, text]) => [h("dt", {}, term), h("dd", {}, text)]));
    const keyRows = keys.filter((key) => key.shown).map((key): [string, string] => [key.shown, key.description]);
    this.element.replaceChildren(
      h("h2", {}, "Gestures"),
      list(gestures(playing)),
      h("h2", {}, "Keys"),
      list(playing ? [...keyRows, onTimeline] : keyRows),
      this.choice,
    );
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else {
      this.element.showModal();
      this.element.focus(); // else the check box has the focus, and space would change it
      this.element.scrollTop = 0;
    }
  }
}
