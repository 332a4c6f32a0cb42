import type { Camera } from "../camera/camera";
import type { Insets } from "../camera/view";
import { modeList } from "../colour/modes";
import type { AutoRange } from "../colour/range";
import type { Commands } from "../connection/commands";
import type { ControlWish } from "../connection/messages";
import type { Recording } from "../gen/spherule/v1/control_pb";
import type { ThemeName } from "../renderer/theme";
import type { Session } from "../scene/session";
import type { Shown } from "../scene/states";
import { ChangeLine } from "./change_line";
import { h } from "./dom";
import { Header } from "./header";
import { Help } from "./help";
import { Inspector } from "./inspector";
import { keysFor } from "./key_list";
import type { KeyActions } from "./key_list";
import { listenForKeys } from "./keys";
import type { Key } from "./keys";
import { Legend } from "./legend";
import { Panel } from "./panel";
import type { Choices, PanelActions } from "./panel";
import { Playback } from "./playback";
import { Prompt } from "./prompt";
import { endOf, RecordButton } from "./record";
import { StatusLine } from "./status";
import { Steering } from "./steering";
import { longStay, Toasts } from "./toasts";
import { Transport } from "./transport";

export interface PageActions extends PanelActions {
  retry(): void;
  submitToken(text: string): boolean;
  aboutControl(wish: ControlWish): void;
  camera: Camera;
}

const narrow = window.matchMedia("(width <= 720px)");

/** All that lies over the picture. */
export class Page {
  readonly toasts = new Toasts();
  readonly inspector = new Inspector();
  readonly panel: Panel;
  readonly playback: Playback;
  readonly prompt: Prompt;
  readonly steering: Steering;
  private readonly header: Header;
  private readonly change: ChangeLine;
  private readonly record: RecordButton;
  private readonly transport: Transport;
  private readonly legend: Legend;
  private readonly status: StatusLine;
  private readonly help = new Help();
  private readonly keys: () => Key[];
  private readonly deck: HTMLElement;
  private deckHeight = 56; // px
  private playing = false; // a recording
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
    const act = {
      toggle: () => this.toggle(),
      step: (count: number) => void commands.step(count, session.timeline ? "frame" : "step"),
      reset: () => void commands.reset(session.timeline ? "To the beginning" : "Reset"),
      panel: () => this.showPanel(this.place.classList.contains("panel-closed")),
      help: () => this.help.toggle(),
    };
    const keyActions: KeyActions = {
      ...act,
      camera: actions.camera,
      colour: (index) => this.panel.colourBy(modeList[index] ?? choices.mode),
      push: () => {
        if (this.steering.hindered()) return;
        choices.push = !choices.push;
        this.panel.refresh();
      },
      lock: () => this.legend.toggleLock(),
      drop: () => this.panel.dropNow(),
      forget: () => {
        this.inspector.select(undefined);
        this.help.element.close();
      },
    };
    this.prompt = new Prompt(location.host, (text) => actions.submitToken(text));
    this.steering = new Steering(session, this.toasts, actions.aboutControl, (why) => this.panel.restrict(why));
    this.keys = () => (this.prompt.open ? [] : keysFor(keyActions, this.playing));
    listenForKeys(() => this.keys());
    this.record = new RecordButton(commands);
    this.change = new ChangeLine(() => void commands.cancel());
    this.transport = new Transport(this.record.element, { ...act, home: () => actions.camera.reset() });
    this.playback = new Playback(session, commands, () => choices.mode === "speed" || this.inspector.selected !== undefined);
    const { header, legend, inspector, panel, status, toasts, help, steering, prompt } = this;
    const facts = h("aside", { class: "facts" }, inspector.element, legend.element);
    this.deck = h("div", { class: "deck" }, h("div", { class: "controls" }, this.change.element, steering.element, this.playback.element, this.transport.element));
    const foot = h("div", { class: "foot" }, h("div", { class: "beside" }, facts, this.deck));
    place.append(header.element, foot, panel.element, status.element, toasts.element, help.element, prompt.element);
    new ResizeObserver(() => this.measureDeck()).observe(this.deck);
    document.documentElement.dataset.theme = choices.theme;
    this.showPanel(!narrow.matches);
    this.help.describe(this.keys(), this.playing);
  }

  /** `now`: ms, as sharedNow() says. */
  update(now: number, shown: Shown | undefined, picturesPerSecond: number, contextLost: boolean): void {
    this.inspector.update(this.session.facts, shown);
    this.setPlaying(this.session.timeline !== undefined);
    this.steering.update();
    const { why } = this.steering;
    this.change.update(this.session.change, why);
    this.transport.update(this.session.paused, why);
    this.playback.update(now, shown, why);
    this.record.offer(this.playing ? undefined : this.session.recording, why);
    this.legend.update(this.choices.mode, this.session.facts);
    document.getElementById("picture")?.classList.toggle("pushing", this.choices.push);
    if (now - this.lastFigures < 200) return; // figures that change faster cannot be read
    this.lastFigures = now;
    this.header.update(now, this.steering.standing, contextLost);
    this.status.update(now, picturesPerSecond);
    this.panel.stream.update(this.session, now);
  }

  recorded(recording: Recording, before: Recording | undefined): void {
    const end = endOf(recording, before);
    if (end) this.toasts.show(end.title, end.text, end.failed ? "bad" : "good", longStay);
  }

  insets(): Insets {
    if (narrow.matches) return { top: 60, right: 0, bottom: this.deckHeight + 104, left: 0 };
    const open = !this.place.classList.contains("panel-closed");
    return { top: 24, right: open ? 304 : 0, bottom: this.deckHeight + 56, left: 0 };
  }

  private setPlaying(playing: boolean): void {
    if (playing === this.playing) return;
    this.playing = playing;
    this.place.classList.toggle("playing", playing);
    this.transport.setPlaying(playing);
    this.panel.setPlaying(playing);
    this.help.describe(this.keys(), playing);
  }

  /** The sheet of controls on a narrow screen stands on what lies below it. */
  private measureDeck(): void {
    this.deckHeight = this.deck.offsetHeight;
    this.place.style.setProperty("--deck", `${this.deckHeight}px`);
  }

  private toggle(): void {
    void (this.session.paused ? this.commands.resume() : this.commands.pause());
  }

  private showPanel(open: boolean): void {
    this.place.classList.toggle("panel-closed", !open);
  }
}
