import { clientName } from "../connection/protocol";
import type { Graphics } from "../model/page_state";
import type { Session } from "../model/session";
import { live, liveText } from "./bindings";
import { h, icon, setText } from "./dom";
import type { Steering } from "./steering";

const info = "M10 3.2a6.8 6.8 0 1 1 0 13.6 6.8 6.8 0 0 1 0-13.6zM10 9.2v4.2M10 6.6v.1";

/** Shows the scene's name and the state of the connection. */
export class Header {
  private readonly about = h(
    "button",
    {
      class: "about",
      type: "button",
      title: "About the scene",
      "aria-label": "About the scene",
      "data-testid": "about",
      click: () => this.describe(!this.element.classList.contains("described")),
    },
    icon(info),
  );
  private readonly dot = h("i");
  private readonly text = h("span", { "data-testid": "connection" });
  private readonly link: HTMLButtonElement;
  readonly element: HTMLElement;

  constructor(
    private readonly session: Session,
    steering: Steering,
    retry: () => void,
  ) {
    const linkAttributes = { class: "link", type: "button", "data-testid": "retry", click: retry };
    this.link = h("button", linkAttributes, this.dot, this.text);
    const role = live(h("span", { class: "role", "data-testid": "role" }, "watching"), {
      hidden: () => steering.state.kind !== "watching",
      title: () => steering.blockedReason,
    });
    const product = [h("span", { class: "mark" }), h("span", { class: "product" }, "Spherule")];
    const brand = h("div", { class: "brand" }, ...product, this.link, role);
    const name = (): string => session.facts?.name ?? "Spherule";
    const about = (): string => session.facts?.description ?? "";
    const scene = live(h("h1", { dir: "auto", "data-testid": "scene-name" }, liveText(name)), { title: name });
    const attributes = { class: "description", dir: "auto", "data-testid": "scene-description" };
    const description = live(h("p", attributes, liveText(about)), { title: about });
    const advice = (): string => session.facts?.whatToTry ?? "";
    const tried = { class: "description try", dir: "auto", "data-testid": "what-to-try" };
    const tryIt = live(h("p", tried, liveText(advice)), { title: advice, hidden: () => advice() === "" });
    live(this.about, { hidden: () => about() + advice() === "" });
    const title = h("div", { class: "title" }, scene, this.about);
    this.element = h("header", {}, brand, title, description, tryIt);
    this.describe(false);
  }

  /** Call several times a second. `now`: ms, as sharedNow() counts. */
  update(now: number, graphics: Graphics): void {
    const { session } = this;
    const state = session.replay?.source ?? (graphics === "lost" ? "lost" : session.connection);
    this.link.dataset.state = state;
    this.link.title = titleFor(state, session);
    setText(this.text, this.textFor(state, now));
  }

  /** Shows or hides the description where the screen has no room for it. */
  private describe(shown: boolean): void {
    this.element.classList.toggle("described", shown);
    this.about.setAttribute("aria-expanded", String(shown));
  }

  private textFor(state: string, now: number): string {
    switch (state) {
      case "past":
        return "showing the past";
      case "file":
        return "showing a file";
      case "lost":
        return "graphics lost, waiting for the browser";
      case "open":
        return this.session.facts ? "connected" : "waiting for the scene";
      case "connecting":
        return "connecting";
      case "locked":
        return "token required";
      case "silent":
        return `no answer for ${Math.round((now - (this.session.silentSince ?? now)) / 1000)} s`;
      default:
        return `offline, trying again in ${Math.max(0, Math.ceil((this.session.retryAt - now) / 1000))} s`;
    }
  }
}

function titleFor(state: string, { linkReason: reason, welcome, control }: Session): string {
  if (state === "past" || state === "file") return "The picture is not live; click to return to the present";
  if (state === "waiting") return `${reason}; click to try now`;
  if (state === "locked") return `${reason}; click to enter a token`;
  if (state === "open" && welcome && control) return `Other clients see this page as ${clientName} #${welcome.session}`;
  return state === "silent" ? "The image is not live: the server does not answer. Click to reconnect" : "";
}
