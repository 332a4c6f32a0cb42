import { clientName } from "../connection/client";
import type { Session } from "../scene/session";
import { hindranceOf } from "../scene/standing";
import type { Standing } from "../scene/standing";
import { h, setText } from "./dom";

/** Which world this is, and whether the page hears from it. */
export class Header {
  private readonly scene = h("h1", { "data-testid": "scene-name" }, "Spherule");
  private readonly description = h("p", { "data-testid": "scene-description" });
  private readonly farewell = h("p", { class: "farewell", "data-testid": "farewell", role: "status" });
  private readonly dot = h("i");
  private readonly words = h("span", { "data-testid": "connection" });
  private readonly role = h("span", { class: "role", "data-testid": "role", hidden: true }, "watching");
  private readonly refusal = h("p", { class: "refusal", "data-testid": "refusal", hidden: true });
  private readonly link: HTMLButtonElement;
  readonly element: HTMLElement;

  constructor(
    private readonly session: Session,
    retry: () => void,
  ) {
    this.link = h("button", { class: "link", type: "button", "data-testid": "retry", click: retry }, this.dot, this.words);
    const brand = h("div", { class: "brand" }, h("span", { class: "mark" }), "Spherule", this.link, this.role);
    this.element = h("header", {}, brand, this.refusal, this.scene, this.farewell, this.description);
  }

  update(now: number, standing: Standing, contextLost: boolean): void {
    const { session } = this;
    const state = contextLost ? "lost" : session.silentSince !== undefined ? "silent" : session.link;
    this.link.dataset.state = state;
    this.link.title = titleFor(state, session);
    setText(this.words, this.wordsFor(state, now));
    this.role.hidden = standing.kind !== "watching";
    this.role.title = hindranceOf(standing);
    setText(this.refusal, session.refusal && `The server says: ${session.refusal}`);
    this.refusal.hidden = !session.refusal;
    setText(this.farewell, session.farewell);
    this.farewell.hidden = session.farewell === "";
    this.description.hidden = session.farewell !== "";
    if (!session.facts) return;
    setText(this.scene, session.facts.name);
    setText(this.description, session.facts.description);
  }

  private wordsFor(state: string, now: number): string {
    switch (state) {
      case "lost":
        return "graphics lost, waiting for the browser";
      case "open":
        return this.session.facts ? "connected" : "waiting for the scene";
      case "connecting":
        return "connecting";
      case "locked":
        return "a token is needed";
      case "silent":
        return `no answer for ${Math.round((now - (this.session.silentSince ?? now)) / 1000)} s`;
      default:
        return `offline, trying again in ${Math.max(0, Math.ceil((this.session.retryAt - now) / 1000))} s`;
    }
  }
}

function titleFor(state: string, { linkReason: reason, welcome, control }: Session): string {
  if (state === "waiting") return `${reason}; click to try now`;
  if (state === "locked") return `${reason}; click to give one`;
  if (state === "open" && welcome && control) return `To others this page is ${clientName} #${welcome.session}`;
  return state === "silent" ? "The picture is not live: nothing comes from the server; click to connect anew" : "";
}
