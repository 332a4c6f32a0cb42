import type { Commands } from "../connection/commands";
import { count } from "../format";
import type { Session } from "../model/session";
import { h, setText, uniqueId } from "../ui/dom";
import { adoptStyle } from "../ui/parts";
import style from "./gallery.css";

interface Card {
  name: string;
  description: string;
  whatToTry: string;
  spheres: number;
  embedded: boolean; // part of the program: the page has its picture, and the server loads it by its name
}

const ownScene = "This scene is not part of the program. Reset returns to its beginning.";

/** A dialog with the scenes of the program, as cards with pictures. A click on a card loads its scene. */
export class Gallery {
  private readonly note = h("p", { id: uniqueId("gallery"), class: "blocked", "data-testid": "gallery-note" });
  private readonly list = h("ul");
  readonly element: HTMLDialogElement;
  private shown: unknown[] = []; // from which the cards were made

  constructor(
    private readonly session: Session,
    private readonly commands: Commands,
  ) {
    adoptStyle(style);
    const title = uniqueId("gallery");
    const close = (): void => this.element.close();
    this.element = h(
      "dialog",
      {
        class: "gallery",
        "data-testid": "gallery",
        "aria-labelledby": title,
        click: ({ target }: Event) => target === this.element && close(), // on the backdrop
      },
      h(
        "div",
        { class: "row" },
        h("h2", { id: title }, "Scenes"),
        h("button", { type: "button", class: "close", title: "Close (Esc)", "aria-label": "Close", click: close }, "×"),
      ),
      this.note,
      this.list,
    );
  }

  get open(): boolean {
    return this.element.open;
  }

  /** `blockedReason`, here and below: why the user may not load a scene; empty if they may. */
  show(blockedReason: string): void {
    this.element.showModal();
    this.update(blockedReason);
    this.list.querySelector<HTMLElement>("[aria-current]")?.focus();
  }

  /** Call at every tick. The pictures are fetched when the dialog is open for the first time. */
  update(blockedReason: string): void {
    if (!this.open) return;
    const { welcome, facts, link } = this.session;
    const reason = link === "open" ? blockedReason : "There is no connection to the server";
    const now = [welcome, facts?.name, facts?.description, reason];
    if (now.every((part, i) => part === this.shown[i])) return;
    this.shown = now;
    setText(this.note, reason && `${reason}.`);
    this.note.hidden = reason === "";
    const before = Array.from(this.list.querySelectorAll("button"), (button) => button === document.activeElement);
    const buttons = this.cards().map((card) => this.buttonOf(card, reason));
    this.list.replaceChildren(...buttons.map((button) => h("li", {}, button)));
    buttons[before.indexOf(true)]?.focus(); // the button that had the focus was replaced
  }

  /** The scenes of the program; before them the present scene, if it is another one. */
  private cards(): Card[] {
    const { welcome, facts } = this.session;
    const cards = (welcome?.gallery ?? []).map(({ name, description, whatToTry, spheres }): Card => {
      return { name, description, whatToTry, spheres, embedded: true };
    });
    if (!facts || cards.some(({ name }) => name === facts.name)) return cards;
    const { name, description, whatToTry, population } = facts;
    return [{ name, description, whatToTry, spheres: population.count, embedded: false }, ...cards];
  }

  private buttonOf({ name, description, whatToTry, spheres, embedded }: Card, blockedReason: string): HTMLElement {
    const reason = embedded ? blockedReason : ownScene;
    const current = name === this.session.facts?.name;
    const image = { src: `scenes/${name}.webp`, alt: "", width: "240", height: "150" };
    const picture = h("span", { class: "picture" }, ...(embedded ? [h("img", image)] : []));
    if (current) picture.append(h("span", { class: "current" }, "shown now"));
    const number = `${count(spheres)} ${spheres === 1 ? "sphere" : "spheres"}`;
    const button = h(
      "button",
      {
        type: "button",
        title: reason,
        "data-testid": `scene-${name}`,
        "aria-disabled": String(reason !== ""),
        click: () => reason || this.load(name),
      },
      picture,
      h("span", { class: "name" }, h("b", { dir: "auto" }, name), h("small", {}, number)),
      h("span", { class: "about", dir: "auto" }, description),
    );
    if (whatToTry) button.append(h("span", { class: "about try", dir: "auto" }, whatToTry));
    if (current) button.setAttribute("aria-current", "true");
    return button;
  }

  private load(name: string): void {
    this.element.close();
    void this.commands.load(name);
  }
}
