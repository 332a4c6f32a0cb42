import type { Outcome } from "../connection/link";
import { count, figure, percent, vector, withPrefix } from "../format";
import type { Contact, Inspected } from "../gen/spherule/v1/control_pb";
import type { Facts } from "../model/facts";
import { shownPosition } from "../model/positions";
import { modes, quantityOf } from "../model/quantities";
import { Selection } from "../model/selection";
import type { Session } from "../model/session";
import type { Shown } from "../model/states";
import { live } from "./bindings";
import { focusWhileScrolling, h, setText, setTitle } from "./dom";

const contactsShown = 6;

/** Shows the selected sphere: its position, its quantities, and its state as the server tells it. */
export class Inspector {
  readonly selection = new Selection();
  private readonly name = h("h2", { "data-testid": "inspected" });
  private readonly lines = h("div");
  private readonly contacts = h("p", { class: "contacts", "data-testid": "contacts", hidden: true });
  private contactsKey = "";
  private removing = false; // the command has no result yet
  readonly element: HTMLElement;

  /** `remove` is given the id of the sphere to remove. `blocked`: why the user may not; empty if they may. */
  constructor(
    session: Session,
    private readonly remove: (id: number) => Promise<Outcome>,
    blocked: () => string,
  ) {
    const deselect = {
      type: "button",
      class: "close",
      title: "Deselect (Esc)",
      "aria-label": "Deselect",
      click: () => this.selection.clear(),
    };
    const click = (): void => void this.removeSelected();
    const removal = live(h("button", { type: "button", "data-testid": "remove", click }, "Remove"), {
      hidden: () => session.playing,
      disabled: () => blocked() !== "",
      title: () => blocked() || "Remove the sphere (Del)",
    });
    const follow = (): void => this.toggleFollowed();
    const following = h("button", { type: "button", "data-testid": "follow", click: follow }, "Follow");
    following.title = "The camera follows the sphere (G)";
    live(following, { "aria-pressed": () => String(this.selection.followed) });
    const body = h("div", { class: "body" }, this.lines, this.contacts);
    focusWhileScrolling(body);
    this.element = h(
      "section",
      { class: "inspector", hidden: true, "aria-label": "Selected sphere" },
      h("div", { class: "row" }, this.name, h("button", deselect, "×")),
      body,
      h("div", { class: "actions" }, following, removal),
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

  /** Call several times a second. `inspected`: the present state of the sphere; undefined: unknown. */
  update(facts: Facts | undefined, shown: Shown | undefined, inspected?: Inspected): void {
    const { id, place } = this.selection;
    const known = facts && shown && id !== undefined && place !== undefined && place < shown.to.count;
    this.element.hidden = !known;
    if (!known) return;
    const lines = modes.flatMap((mode) => quantityOf(mode).describe?.(facts, shown, place) ?? []);
    if (inspected) lines[0] = `${figure(Math.hypot(...inspected.velocity))} m/s`;
    setText(this.name, `Sphere ${count(id)}`);
    const more = inspected ? linesOf(inspected) : [];
    this.show([`at ${vector(shownPosition(facts, shown, place), 3)} m`, ...lines, ...more]);
    this.showContacts(facts, inspected);
  }

  /** The bodies that the sphere touches; a click on a sphere selects it. */
  private showContacts(facts: Facts, inspected: Inspected | undefined): void {
    this.contacts.hidden = !inspected;
    if (!inspected) return;
    const total = inspected.contactCount;
    const shown = inspected.contacts.slice(0, contactsShown).sort(byName);
    const key = [total, ...shown.map(nameOf)].join(" ");
    if (key === this.contactsKey) return;
    this.contactsKey = key;
    const links = shown.map((contact) => {
      const { case: kind, value } = contact.with;
      if (kind !== "sphere") return h("span", {}, nameOf(contact));
      const click = (): void => this.selection.select(facts.population, facts.population.placeOf(Number(value)));
      const title = `Select sphere ${count(value)}`;
      return h("button", { type: "button", class: "contact", title, "aria-label": title, click }, count(value));
    });
    const more = total > shown.length ? [`and ${count(total - shown.length)} more`] : [];
    this.contacts.replaceChildren(total === 0 ? "no contacts" : `touches ${count(total)}: `, ...links, ...more);
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

function linesOf({ velocity, spin, mass, material, contacts }: Inspected): string[] {
  const deepest = Math.max(0, ...contacts.map(({ overlap }) => overlap));
  return [
    `velocity ${vector(velocity)} m/s`,
    `spin ${vector(spin)} rad/s`,
    mass === undefined ? "fixed" : `mass ${massText(mass)}`,
    ...(material ? [`material ${material}`] : []),
    ...(contacts.length > 0 ? [`largest overlap ${percent(deepest)}`] : []),
  ];
}

function massText(kilograms: number): string {
  return kilograms >= 1e3 ? `${figure(kilograms)} kg` : withPrefix(1e3 * kilograms, "g");
}

function nameOf({ with: body }: Contact): string {
  if (body.case === "sphere") return count(body.value);
  const obstacle = /^obstacles\[(\d+)\]$/.exec(body.value ?? "");
  return obstacle ? `obstacle ${obstacle[1]}` : `wall ${body.value}`;
}

/** Surfaces first, then spheres by id. */
function byName({ with: a }: Contact, { with: b }: Contact): number {
  if (a.case === "sphere" && b.case === "sphere") return a.value < b.value ? -1 : 1;
  if (a.case === b.case) return String(a.value) < String(b.value) ? -1 : 1;
  return a.case === "sphere" ? 1 : -1;
}
