import type { Camera } from "../camera/camera";
import type { Insets } from "../camera/view";
import { modeList } from "../colour/modes";
import type { AutoRange } from "../colour/range";
import type { Commands } from "../connection/commands";
import type { ThemeName } from "../renderer/theme";
import type { Session } from "../scene/session";
import type { Shown } from "../scene/states";
import { h } from "./dom";
import { Header } from "./header";
import { Help } from "./help";
import { Inspector } from "./inspector";
import { keysFor } from "./key_list";
import { listenForKeys } from "./keys";
import { Legend } from "./legend";
import { Panel } from "./panel";
import type { Choices, PanelActions } from "./panel";
import { StatusLine } from "./status";
import { Toasts } from "./toasts";
import { Transport } from "./transport";

export interface PageActions extends PanelActions {
  retry(): void;
  camera: Camera;
}

const narrow = window.matchMedia("(width <= 720px)");

/** All that lies over the picture. */
export class Page {
  readonly toasts = new Toasts();
  readonly inspector = new Inspector();
  readonly panel: Panel;
  private readonly header: Header;
  private readonly transport: Transport;
  private readonly legend: Legend;
  private readonly status: StatusLine;
  private readonly help: Help;
  private lastFigures = 0;

  constructor(
    private readonly place: HTMLElement,
    private readonly session: Session,
    private readonly commands: Commands,
    speeds: AutoRange,
    private readonly choices: Choices,
    actions: PageActions,
  ) {
    const themed = (theme: ThemeName): void => {
      document.documentElement.dataset.theme = theme;
      actions.themed(theme);
    };
    this.panel = new Panel(commands, choices, { ...actions, themed });
    this.header = new Header(session, actions.retry);
    this.legend = new Legend(speeds, () => {
      this.panel.colourBy(modeList[(modeList.indexOf(choices.mode) + 1) % modeList.length] ?? "speed");
    });
    this.status = new StatusLine(session);
    const toggle = (): void => this.toggle();
    const panel = (): void => this.showPanel(this.place.classList.contains("panel-closed"));
    const keys = keysFor({
      toggle,
      panel,
      commands,
      camera: actions.camera,
      colour: (index) => this.panel.colourBy(modeList[index] ?? choices.mode),
      push: () => {
        choices.push = !choices.push;
        this.panel.refresh();
      },
      lock: () => this.legend.toggleLock(),
      drop: () => this.panel.dropNow(),
      help: () => this.help.toggle(),
      forget: () => {
        this.inspector.select(undefined);
        this.help.element.close();
      },
    });
    this.help = new Help(keys);
    listenForKeys(keys);
    const home = (): void => actions.camera.reset();
    this.transport = new Transport(commands, { toggle, home, panel, help: () => this.help.toggle() });
    const { header, legend, inspector, transport, status, toasts, help } = this;
    const facts = { element: h("aside", { class: "facts" }, inspector.element, legend.element) };
    place.append(...[header, facts, transport, this.panel, status, toasts, help].map((part) => part.element));
    document.documentElement.dataset.theme = choices.theme;
    this.showPanel(!narrow.matches);
  }

  /** `now`: ms, as sharedNow() says. */
  update(now: number, shown: Shown | undefined, picturesPerSecond: number, contextLost: boolean): void {
    this.inspector.update(this.session.facts, shown);
    this.transport.update(this.session.paused);
    this.legend.update(this.choices.mode, this.session.facts);
    document.getElementById("picture")?.classList.toggle("pushing", this.choices.push);
    if (now - this.lastFigures < 200) return; // figures that change faster cannot be read
    this.lastFigures = now;
    this.header.update(now, contextLost);
    this.status.update(now, picturesPerSecond);
    this.panel.stream.update(this.session, now);
  }

  insets(): Insets {
    if (narrow.matches) return { top: 60, right: 0, bottom: 160, left: 0 };
    const open = !this.place.classList.contains("panel-closed");
    return { top: 24, right: open ? 304 : 0, bottom: 112, left: 0 };
  }

  private toggle(): void {
    void (this.session.paused ? this.commands.resume() : this.commands.pause());
  }

  private showPanel(open: boolean): void {
    this.place.classList.toggle("panel-closed", !open);
  }
}
