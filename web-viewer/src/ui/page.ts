import type { Camera } from "../camera/camera";
import type { Insets } from "../camera/view";
import type { Commands } from "../connection/commands";
import type { ControlMessage } from "../connection/messages";
import type { Recording } from "../gen/spherule/v1/control_pb";
import type { ColourRanges } from "../model/colour_ranges";
import { modes } from "../model/quantities";
import type { Session } from "../model/session";
import type { Shown } from "../model/states";
import type { ThemeName } from "../renderer/theme";
import { ChangeLine } from "./change_line";
import { h } from "./dom";
import { Gallery } from "./gallery";
import { Header } from "./header";
import { Help } from "./help";
import { Inspector } from "./inspector";
import { CharacterKeys, keysFor, listenForKeys } from "./keys";
import type { Key, KeyActions } from "./keys";
import { Legend } from "./legend";
import { Panel } from "./panel";
import type { Choices, PanelActions } from "./panel";
import { Playback } from "./playback";
import { Prompt } from "./prompt";
import { RecordButton, recordingEnd } from "./record";
import { StatusLine } from "./status";
import { Steering } from "./steering";
import { longStay, Toasts } from "./toasts";
import { Transport } from "./transport";

export interface PageActions extends Omit<PanelActions, "showScenes"> {
  retry(): void;
  submitToken(text: string): boolean;
  sendControl(message: ControlMessage): void;
  camera: Camera;
}

const narrow = window.matchMedia("(width <= 720px)");
const figurePeriod = 200; // ms; figures that change faster cannot be read

/** All elements over the canvas. */
export class Page {
  readonly toasts = new Toasts();
  readonly inspector: Inspector;
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
  private readonly characters = new CharacterKeys(() => localStorage);
  private readonly help = new Help(this.characters);
  private readonly gallery: Gallery;
  private readonly keys: () => Key[];
  private readonly deck: HTMLElement;
  private deckHeight = 56; // px
  private playing = false; // the server plays a recording
  private lastFigures = 0; // ms

  constructor(
    private readonly container: HTMLElement,
    private readonly session: Session,
    private readonly commands: Commands,
    ranges: ColourRanges,
    private readonly choices: Choices,
    actions: PageActions,
  ) {
    const themeChanged = (theme: ThemeName): void => {
      document.documentElement.dataset.theme = theme;
      actions.themeChanged(theme);
    };
    this.gallery = new Gallery(session, commands);
    const showScenes = (): void => this.gallery.show(this.steering.blockedReason);
    this.panel = new Panel(commands, choices, { ...actions, themeChanged, showScenes });
    this.inspector = new Inspector((id) => commands.remove(id));
    this.header = new Header(session, actions.retry);
    this.legend = new Legend(ranges, () => {
      this.panel.colourBy(modes[(modes.indexOf(choices.mode) + 1) % modes.length] ?? "speed");
    });
    this.status = new StatusLine(session);
    const shared = {
      toggle: () => this.toggle(),
      step: (count: number) => void commands.step(count, session.timeline ? "frame" : "step"),
      reset: () => void commands.reset(session.timeline ? "Go to the beginning" : "Reset"),
      panel: () => this.showPanel(this.container.classList.contains("panel-closed")),
      help: () => this.help.toggle(),
    };
    const keyActions: KeyActions = {
      ...shared,
      camera: actions.camera,
      colour: (mode) => this.panel.colourBy(mode),
      push: () => {
        if (this.steering.blocked()) return;
        choices.push = !choices.push;
        this.panel.refresh();
      },
      lock: () => ranges.toggleLock(),
      drop: () => this.panel.dropNow(),
      remove: () => void this.inspector.removeSelected(),
      deselect: () => {
        this.inspector.selection.clear();
        this.help.element.close();
      },
    };
    this.prompt = new Prompt(location.host, (text) => actions.submitToken(text));
    this.steering = new Steering(session, this.toasts, actions.sendControl, (reason) => this.panel.restrict(reason));
    this.keys = () => (this.prompt.open || this.gallery.open ? [] : keysFor(keyActions, this.playing));
    listenForKeys(() => this.keys(), this.characters);
    this.record = new RecordButton(commands);
    this.change = new ChangeLine(() => void commands.cancel());
    this.transport = new Transport(this.record.element, { ...shared, home: () => actions.camera.reset() });
    const needsSpeeds = (): boolean => choices.mode === "speed" || this.inspector.selection.id !== undefined;
    this.playback = new Playback(session, commands, needsSpeeds);
    const { header, legend, inspector, panel, status, toasts, help, steering } = this;
    const facts = h("aside", { class: "facts" }, inspector.element, legend.element);
    const controls = [this.change, steering, this.playback, this.transport].map(({ element }) => element);
    this.deck = h("div", { class: "deck" }, h("div", { class: "controls" }, ...controls));
    const foot = h("div", { class: "foot" }, h("div", { class: "beside" }, facts, this.deck));
    const dialogs = [help, this.gallery, this.prompt].map(({ element }) => element);
    container.append(header.element, foot, panel.element, status.element, toasts.element, ...dialogs);
    new ResizeObserver(() => this.measureDeck()).observe(this.deck);
    document.documentElement.dataset.theme = choices.theme;
    this.showPanel(!narrow.matches);
    this.help.describe(this.keys(), this.playing);
  }

  /** Call at every tick. `now`: ms, as sharedNow() counts. */
  update(now: number, shown: Shown | undefined, imagesPerSecond: number, contextLost: boolean): void {
    this.setPlaying(this.session.timeline !== undefined);
    this.steering.update();
    const { blockedReason } = this.steering;
    this.inspector.update(this.session.facts, shown, this.playing, blockedReason);
    this.change.update(this.session.change, blockedReason);
    this.transport.update(this.session.paused, blockedReason);
    this.playback.update(now, shown, blockedReason);
    this.record.update(this.playing ? undefined : this.session.recording, blockedReason);
    this.legend.update(this.choices.mode, this.session.facts);
    this.gallery.update(blockedReason);
    document.getElementById("picture")?.classList.toggle("pushing", this.choices.push);
    if (now - this.lastFigures < figurePeriod) return;
    this.lastFigures = now;
    this.header.update(now, this.steering.state, contextLost);
    this.status.update(now, imagesPerSecond);
    this.panel.stream.update(this.session, now);
  }

  recordingChanged(recording: Recording, before: Recording | undefined): void {
    const end = recordingEnd(recording, before);
    if (end) this.toasts.show(end.title, end.text, end.failed ? "bad" : "good", longStay);
  }

  /** The margins of the canvas that the page's elements cover (CSS pixels). */
  insets(): Insets {
    if (narrow.matches) return { top: 60, right: 0, bottom: this.deckHeight + 104, left: 0 };
    const open = !this.container.classList.contains("panel-closed");
    return { top: 24, right: open ? 304 : 0, bottom: this.deckHeight + 56, left: 0 };
  }

  private setPlaying(playing: boolean): void {
    if (playing === this.playing) return;
    this.playing = playing;
    this.container.classList.toggle("playing", playing);
    this.transport.setPlaying(playing);
    this.panel.setPlaying(playing);
    this.help.describe(this.keys(), playing);
  }

  /** On a narrow screen the panel lies above the deck: passes the deck's height to the style sheet. */
  private measureDeck(): void {
    this.deckHeight = this.deck.offsetHeight;
    this.container.style.setProperty("--deck", `${this.deckHeight}px`);
  }

  private toggle(): void {
    void (this.session.paused ? this.commands.resume() : this.commands.pause());
  }

  private showPanel(open: boolean): void {
    this.container.classList.toggle("panel-closed", !open);
  }
}
