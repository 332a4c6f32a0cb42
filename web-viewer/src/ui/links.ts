import type { Camera } from "../camera/camera";
import { eyeOf } from "../camera/orbit";
import { count } from "../format";
import type { Facts } from "../model/facts";
import { fragmentOf, linkIn } from "../model/page_link";
import type { PageLink } from "../model/page_link";
import type { Mode } from "../model/quantities";
import type { Selection } from "../model/selection";
import type { Session } from "../model/session";
import type { Site } from "./hosts";
import { longStay } from "./toasts";
import type { Toasts } from "./toasts";

export interface LinkParts {
  camera: Camera;
  selection: Selection;
  colour(): Mode;
  colourBy(mode: Mode): void;
}

/** A scene that a link wants, while the server shows another one. */
export interface WantedScene {
  name: string;
  shown: string; // name of the scene that the server shows
  loadable: boolean; // the server has the wanted scene
}

/** Copies links to the present view, and restores the view of the link with which the page was opened. */
export class Links {
  private pending: PageLink | undefined; // not restored yet: the server shows another scene, or none

  constructor(
    private readonly session: Session,
    private readonly toasts: Toasts,
    private readonly site: Site,
    private readonly parts: LinkParts,
  ) {
    if (!site.own) return;
    window.addEventListener("hashchange", () => this.open());
    this.open();
  }

  /** Undefined if the page waits for no other scene. */
  get wanted(): WantedScene | undefined {
    const { facts, welcome } = this.session;
    const name = this.pending?.scene;
    if (!facts || !name || facts.name === name) return undefined;
    return { name, shown: facts.name, loadable: welcome?.scenes.includes(name) ?? false };
  }

  /** Forgets the scene that the link wants. */
  dismiss(): void {
    this.pending = undefined;
  }

  /** Call when the facts of a scene have arrived. */
  sceneShown(facts: Facts): void {
    const { pending, parts } = this;
    if (!pending || (pending.scene && pending.scene !== facts.name)) return;
    this.pending = undefined;
    const { camera, colour, sphere } = pending;
    if (camera) parts.camera.place(camera.eye, camera.target);
    if (colour) parts.colourBy(colour);
    if (sphere === undefined) return;
    const place = facts.population.placeOf(sphere);
    parts.selection.select(facts.population, place);
    if (parts.selection.id === undefined) this.tell([`There is no sphere ${count(sphere)} in the scene now.`]);
  }

  async copy(): Promise<void> {
    const { camera, selection, colour } = this.parts;
    const eye = eyeOf(camera.pose);
    const view = { eye, target: camera.pose.target };
    const link = { scene: this.session.facts?.name, camera: view, colour: colour(), sphere: selection.id };
    const address = new URL(fragmentOf(link), this.site.server).href;
    try {
      await navigator.clipboard.writeText(address);
      this.toasts.show("Link copied", "It opens this view.", "good");
    } catch {
      // Browsers let pages copy only from secure addresses, and if the user allows it.
      if (this.site.own) history.replaceState(history.state, "", address);
      const where = this.site.own ? "The link is in the address bar." : address;
      this.toasts.show("Not copied", `The browser does not let this page copy. ${where}`, "bad");
    }
  }

  private open(): void {
    if (location.hash.length < 2) return;
    const { link, faults } = linkIn(location.hash);
    this.pending = link;
    if (faults.length > 0) this.tell(faults);
    if (this.session.facts) this.sceneShown(this.session.facts);
  }

  private tell(faults: string[]): void {
    this.toasts.show("Ignored in the link", faults.join(" "), "bad", { stay: longStay });
  }
}
