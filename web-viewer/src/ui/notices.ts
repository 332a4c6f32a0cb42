import type { Graphics, PageState, Situation } from "../model/page_state";
import { count, sentence } from "../format";
import { h, setText } from "./dom";
import type { WantedScene } from "./links";

export type NoticeAction = "retry" | "token" | "drop" | "choose" | "reload" | "reset" | "load" | "dismiss";

/** A notice stays until its cause is gone or the user dismisses it. */
export interface Notice {
  id: Situation | "no-graphics" | "graphics-lost" | "outside" | "diverged" | "link";
  title: string;
  text: string;
  actions: NoticeAction[];
  patient: boolean; // shown only once its cause has lasted a while
}

/** The facts from which the notices follow. */
export interface NoticeInfo {
  state: PageState;
  graphics: Graphics;
  host: string; // of the server
  refusal: string; // why the server refused this page
  farewell: string; // why the server ended
  outside: number; // spheres outside the bounds, if a notice is due
  link: WantedScene | undefined; // the page was opened by a link to another scene
  diverged: boolean; // the simulation became non-finite, and a notice is due
  known: boolean; // a scene is shown, although it may be old
}

/** All notices for this state, most important first. */
export function noticesFor(info: NoticeInfo): Notice[] {
  const notices = [situationNotice(info), graphicsNotice(info.graphics)];
  if (info.state.current && info.link) notices.push(linkNotice(info.link));
  if (info.state.current && info.diverged) {
    notices.push({
      id: "diverged",
      title: "The simulation became unstable",
      text: "It is paused in its last good state. Choose a better quality and resume, or reset the scene.",
      actions: ["reset", "dismiss"],
      patient: false,
    });
  }
  if (info.state.current && info.outside > 0) {
    notices.push({
      id: "outside",
      title: `${count(info.outside)} ${info.outside === 1 ? "sphere" : "spheres"} left the scene`,
      text: "",
      actions: ["reset", "dismiss"],
      patient: false,
    });
  }
  return notices.filter((notice) => notice !== undefined);
}

function situationNotice({ state, host, refusal, farewell, known }: NoticeInfo): Notice | undefined {
  const old = known ? " The picture and the figures are old." : "";
  const { situation: id } = state;
  switch (id) {
    case "connecting":
      return { id, title: "Connecting", text: `to ${host}`, actions: [], patient: true };
    case "waiting":
      return { id, title: "Waiting for the scene", text: `from ${host}`, actions: [], patient: true };
    case "empty":
      return {
        id,
        title: "This scene has no spheres yet",
        text: "Drop some, or choose a scene.",
        actions: ["drop", "choose"],
        patient: false,
      };
    case "silent":
      return { id, title: "The server does not answer", text: old.trim(), actions: ["retry"], patient: false };
    case "offline":
      return {
        id,
        title: "No connection to the server",
        text: `This page tries again by itself.${old}`,
        actions: ["retry"],
        patient: true,
      };
    case "refused":
      return {
        id,
        title: "The server refused this page",
        text: `It says: ${sentence(refusal)} This page tries again by itself.${old}`,
        actions: ["retry"],
        patient: false,
      };
    case "ended":
      return {
        id,
        title: "The server has ended",
        text: `It says: ${sentence(farewell)} This page goes on by itself when it runs again.${old}`,
        actions: ["retry"],
        patient: false,
      };
    case "lost":
      return {
        id,
        title: "The server has lost its device",
        text: `It says: ${sentence(farewell)}${old}`,
        actions: ["retry"],
        patient: false,
      };
    case "locked":
      return { id, title: "Token required", text: `${host} requires a token.`, actions: ["token"], patient: false };
    case "live":
      return undefined;
  }
}

function linkNotice({ name, shown, loadable }: WantedScene): Notice {
  return {
    id: "link",
    title: `This link is for ${name}`,
    text: `The server shows ${shown}${loadable ? ". Load it for all viewers?" : ` and does not have ${name}.`}`,
    actions: loadable ? ["load", "dismiss"] : ["dismiss"],
    patient: false,
  };
}

function graphicsNotice(graphics: Graphics): Notice | undefined {
  switch (graphics) {
    case "none":
      return {
        id: "no-graphics",
        title: "This browser cannot draw the spheres",
        text:
          "It has no WebGL 2. Switch on hardware acceleration in its settings, or use a current Chrome, Edge, " +
          "Firefox or Safari. Controls and figures work without the picture.",
        actions: ["reload"],
        patient: false,
      };
    case "lost":
      return {
        id: "graphics-lost",
        title: "The browser has stopped the drawing",
        text: "It usually goes on within seconds. If not, reload. The simulation is not affected.",
        actions: ["reload"],
        patient: false,
      };
    case "ok":
      return undefined;
  }
}

const actionNames: Record<NoticeAction, string> = {
  retry: "Try now",
  token: "Enter a token",
  drop: "Drop spheres",
  choose: "Choose a scene",
  reload: "Reload",
  reset: "Reset",
  load: "Load it",
  dismiss: "Dismiss",
};

const needsConnection: NoticeAction[] = ["drop", "choose", "reset", "load"];
const patience = 1000; // ms

/** Shows the notices above the transport. */
export class Notices {
  readonly element = h("div", { class: "notices", role: "status", "data-testid": "notices", hidden: true });
  private readonly since = new Map<string, number>(); // ms: when the cause of a patient notice began
  private shown = ""; // the notices on the page

  /** `act` is given the notice to which an action belongs. */
  constructor(private readonly act: (action: NoticeAction, notice: Notice) => void) {}

  /** `now`: ms; `blockedReason`: why the user may not send commands; empty if they may. */
  update(notices: Notice[], now: number, blockedReason: string): void {
    const due = this.due(notices, now);
    const key = JSON.stringify([due, blockedReason]);
    if (key === this.shown) return;
    this.shown = key;
    const focused = this.element.contains(document.activeElement);
    this.element.hidden = due.length === 0;
    this.element.replaceChildren(...due.map((notice) => this.card(notice, blockedReason)));
    if (focused) this.element.querySelector("button")?.focus(); // the button that had the focus was replaced
  }

  private due(notices: Notice[], now: number): Notice[] {
    for (const id of this.since.keys()) if (!notices.some((notice) => notice.id === id)) this.since.delete(id);
    return notices.filter(({ id, patient }) => {
      const since = this.since.get(id) ?? now;
      this.since.set(id, since);
      return !patient || now - since >= patience;
    });
  }

  private card(notice: Notice, blockedReason: string): HTMLElement {
    const buttons = notice.actions.map((action) => {
      const button = h(
        "button",
        { type: "button", "data-testid": `notice-${action}`, click: () => this.act(action, notice) },
        actionNames[action],
      );
      const reason = needsConnection.includes(action) ? blockedReason : "";
      button.disabled = reason !== "";
      button.title = reason;
      return button;
    });
    const text = h("p", { "data-testid": "notice-text" });
    setText(text, notice.text);
    text.hidden = !notice.text;
    const head = h("strong", { "data-testid": "notice-title" }, notice.title);
    return h(
      "section",
      { class: "notice", "data-testid": "notice", "data-notice": notice.id },
      h("div", { class: "words" }, head, text),
      h("div", { class: "row" }, ...buttons),
    );
  }
}

/** Decides whether to tell the user how many spheres are outside: not again unless the number has doubled. */
export class OutsideCount {
  private dismissed = 0;

  due(outside: number): number {
    if (outside === 0) this.dismissed = 0; // all are inside again, or the scene is another one
    return outside >= 2 * this.dismissed && outside > 0 ? outside : 0;
  }

  dismiss(outside: number): void {
    this.dismissed = outside;
  }
}
