import { effect } from "@preact/signals-core";
import type { Camera } from "../camera/camera";
import type { Box } from "../camera/free_part";
import type { DrawClock } from "../clock";
import type { Commands } from "../connection/commands";
import { fileNameOf } from "../connection/file_name";
import type { ControlMessage } from "../connection/messages";
import { sentence } from "../format";
import type { Event, Recording } from "../gen/spherule/v1/control_pb";
import { Quantity } from "../gen/spherule/v1/frame_pb";
import type { Choices } from "./choices";
import type { ColourRanges } from "../model/colour_ranges";
import { Inspection } from "../model/inspection";
import { modes, quantityOf } from "../model/quantities";
import type { Graphics } from "../model/page_state";
import type { Session } from "../model/session";
import type { Shown } from "../model/states";
import { observed } from "../observed";
import { announcementOf } from "./announcements";
import { liveClass } from "./bindings";
import { ChangeLine } from "./change_line";
import { h } from "./dom";
import { Files } from "./files";
import { Header } from "./header";
import { Gauge } from "./gauge";
import { Help } from "./help";
import type { Site } from "./hosts";
import { Inspector } from "./inspector";
import { CharacterKeys, keysFor, listenForKeys } from "./keys";
import type { Key, KeyActions } from "./keys";
import { Legend } from "./legend";
import { Lazy } from "./lazy";
import { Links } from "./links";
import { Notices, noticesFor, OutsideCount } from "./notices";
import type { Notice, NoticeAction } from "./notices";
import { Panel } from "./panel";
import { loadPart } from "./parts";
import type { LoadPart } from "./parts";
import type { PanelActions } from "./panel";
import { Playback } from "./playback";
import { Prompt } from "./prompt";
import { RecordButton, recordingEnd } from "./record";
import { StatusLine } from "./status";
import { Steering } from "./steering";
import { whenSystemThemeChanges } from "./system_theme";
import { longStay, Toasts } from "./toasts";
import { Transport } from "./transport";

type OwnActions = "showScenes" | "copyLink" | "openFile" | "saveScene" | "editScene" | "savePicture" | "loadPart";

export interface PageActions extends Omit<PanelActions, OwnActions> {
  retry(): void;
  present(): void; // shows the simulation as it is now
  save(): void; // the last seconds, as a recording
  play(recording: File): void;
  fetchFile(path: string): Promise<Blob>; // from the server
  click(x: number, y: number): void; // on the canvas
  submitToken(text: string): boolean;
  sendControl(message: ControlMessage): void;
  /** Makes a picture (px), as PNG; undefined if `progress` has returned false. */
  picture(width: number, height: number, progress: (share: number) => boolean): Promise<Blob | undefined>;
  wake(): void; // the page may look different
  camera: Camera;
}

const updatePeriod = 100; // ms; elements that follow the picture need no more
const figurePeriod = 200; // ms; figures that change faster cannot be read

/** All elements over the canvas. */
export class Page {
  readonly toasts = new Toasts();
  readonly inspector: Inspector;
  readonly panel: Panel;
  readonly playback: Playback;
  readonly prompt: Prompt;
  readonly links: Links;
  readonly files: Files;
  readonly steering: Steering;
  readonly lazy: Lazy;
  private readonly container = h("div", { class: "page" });
  /** Where elements cover the canvas; another array after each change. */
  covered: readonly Box[] = [];
  private readonly header: Header;
  private readonly inspection: Inspection;
  private makesPicture = false;
  /** The completed share of the picture that is made. Undefined: none is, or it was cancelled. */
  @observed private accessor picture: number | undefined;
  private readonly notices: Notices;
  private readonly outside = new OutsideCount();
  private readonly gauge = new Gauge();
  private readonly legend: Legend;
  private readonly status: StatusLine;
  private readonly characters = new CharacterKeys(() => localStorage);
  private readonly help = new Help(this.characters);
  private readonly keys: () => Key[];
  private lastUpdate = 0; // ms
  private lastFigures = 0; // ms

  constructor(
    private readonly site: Site,
    private readonly session: Session,
    private readonly commands: Commands,
    ranges: ColourRanges,
    private readonly choices: Choices,
    private readonly actions: PageActions,
  ) {
    const { host, own } = site;
    const { container } = this;
    const suffix = own || !host.ariaLabel ? "" : ` (${host.ariaLabel})`; // tells the regions of several viewers apart
    const themed = own ? document.documentElement : host;
    effect(() => void (themed.dataset.theme = choices.theme));
    whenSystemThemeChanges((theme) => {
      if (!choices.themeChosen) choices.theme = theme;
    });
    this.steering = new Steering(session, this.toasts, actions.sendControl);
    const blocked = (): string => this.steering.blockedReason;
    const showScenes = (): void => void this.lazy.showGallery(blocked());
    const editScene = (text?: Promise<string>): void => {
      if (!this.steering.blocked("load")) void this.lazy.editScene(text);
    };
    const openers = {
      ".sph": { what: "recordings", open: actions.play },
      ".json": { what: "scenes", open: (file: File) => editScene(file.text()) },
    };
    this.files = new Files(openers, this.toasts, host, container);
    const saveScene = (): void => {
      const name = `${session.facts?.name || "scene"}.json`;
      void this.fetchFile("scene.json", name, (file) => this.files.give(file, name));
    };
    const openFile = (): void => this.files.choose();
    const copyLink = (): void => void this.links.copy();
    const load: LoadPart = (name) => loadPart(name, this.toasts);
    const savePicture = (width: number, height: number): void => void this.savePicture(width, height);
    const files = { openFile, saveScene, editScene: () => editScene(), savePicture };
    const more = { showScenes, copyLink, loadPart: load };
    this.panel = new Panel(session, commands, this.steering, choices, { ...actions, ...files, ...more });
    this.inspector = new Inspector(session, (id) => commands.remove(id), blocked);
    this.inspection = new Inspection(session, (id) => commands.inspect(id));
    this.links = new Links(session, this.toasts, site, {
      camera: actions.camera,
      selection: this.inspector.selection,
      colour: () => choices.mode,
      colourBy: (mode) => choices.colourBy(mode),
    });
    this.header = new Header(session, this.steering, () => (session.replay ? actions.present() : actions.retry()));
    this.legend = new Legend(ranges, load, () => {
      choices.colourBy(modes[(modes.indexOf(choices.mode) + 1) % modes.length] ?? "speed");
    });
    this.status = new StatusLine(session);
    const shared = {
      toggle: () => this.toggle(),
      step: (count: number) => void commands.step(count, session.timeline || session.replay ? "frame" : "step"),
      reset: () => void commands.reset(session.timeline ? "Go to the beginning" : "Reset"),
      panel: () => this.showPanel(this.container.classList.contains("panel-closed")),
      help: () => this.help.toggle(),
      home: () => {
        this.inspector.selection.followed = false;
        actions.camera.reset();
      },
    };
    const keyActions: KeyActions = {
      ...shared,
      camera: actions.camera,
      present: () => actions.present(),
      colour: (mode) => choices.colourBy(mode),
      push: () => {
        if (this.steering.blocked()) return;
        choices.tool = choices.tool === "push" ? "select" : "push";
      },
      middle: () => {
        const { width, height } = actions.camera.last;
        actions.click(width / 2, height / 2);
      },
      move: (across, up, away) => this.lazy.tools?.move(across, up, away) ?? false,
      lock: () => ranges.toggleLock(),
      drop: () => this.panel.dropNow(),
      follow: () => this.inspector.toggleFollowed(),
      remove: () => void this.inspector.removeSelected(),
      deselect: () => {
        if (this.lazy.tools?.letGo()) return;
        this.inspector.selection.clear();
        this.help.element.close();
      },
    };
    this.prompt = new Prompt(site.server.host, (text) => actions.submitToken(text));
    const keys = { live: keysFor(keyActions, false), playing: keysFor(keyActions, true) };
    const typing = (): boolean => this.prompt.open || this.lazy.dialog;
    this.keys = () => (typing() ? [] : session.playing ? keys.playing : keys.live);
    listenForKeys(host, () => this.keys(), this.characters);
    this.lazy = new Lazy({
      container,
      session,
      commands,
      choices,
      camera: actions.camera,
      panel: this.panel,
      selection: this.inspector.selection,
      toasts: this.toasts,
      blocked: () => this.steering.blocked(),
    });
    const record = new RecordButton(session, commands, blocked);
    const change = new ChangeLine(
      () => session.change,
      blocked,
      () => void commands.cancel(),
    );
    const drawing = new ChangeLine(
      () => (this.picture === undefined ? undefined : { what: "picture", doing: "", share: this.picture }),
      () => "",
      () => (this.picture = undefined),
      "drawing",
    );
    this.notices = new Notices((action, { id }) => {
      if (action === "retry" || action === "token") actions.retry();
      else if (action === "dismiss") this.dismiss(id);
      else this.act(action);
    });
    const transport = new Transport(session, blocked, record.element, shared, suffix);
    this.playback = new Playback(session, commands, () => this.quantity !== Quantity.QUANTITY_UNSPECIFIED, {
      present: () => actions.present(),
      save: () => actions.save(),
    });
    const { header, legend, inspector, panel, status, toasts, help, steering } = this;
    const facts = h("aside", { class: "facts" }, this.gauge.element, inspector.element, legend.element);
    const parts = [this.notices, change, drawing, steering, this.playback, transport];
    const lines = parts.map(({ element }) => element);
    const controls = h("div", { class: "controls" }, ...lines);
    const deck = h("div", { class: "deck" }, controls);
    const foot = h("div", { class: "foot" }, h("div", { class: "beside" }, facts, deck));
    const dialogs = [help, this.prompt].map(({ element }) => element);
    container.append(header.element, foot, panel.element, status.element, toasts.element, ...dialogs);
    for (const part of container.querySelectorAll(":is(section, .panel)[aria-label]:not(.transport)")) {
      part.ariaLabel = `${part.ariaLabel ?? ""}${suffix}`;
    }
    const covering = [header, this.gauge, inspector, legend, panel, status].map(({ element }) => element);
    this.observe([...covering, controls]);
    this.showPanel(host.clientWidth > 720 && host.clientHeight > 480);
    host.append(container);
    effect(() => this.help.describe(session.playing ? keys.playing : keys.live, session.playing));
    liveClass(container, "playing", () => session.playing);
    liveClass(container, "old", () => !session.state.current);
    liveClass(site.view, "aiming", () => choices.tool !== "select");
  }

  /** The quantity that the page needs in frames; unspecified: none. */
  get quantity(): Quantity {
    const { sent } = quantityOf(this.choices.mode);
    return sent ?? (this.inspector.selection.id === undefined ? Quantity.QUANTITY_UNSPECIFIED : Quantity.SPEED);
  }

  /** Call at every tick. `now`: ms, as sharedNow() counts. */
  update(now: number, shown: Shown | undefined, clock: DrawClock, graphics: Graphics): void {
    if (now - this.lastUpdate < updatePeriod) return;
    this.lastUpdate = now;
    const { blockedReason } = this.steering;
    this.container.classList.toggle("no-graphics", graphics === "none");
    this.showNotices(graphics, now);
    const inspected = this.inspection.update(this.inspector.selection.id, now);
    this.inspector.update(this.session.facts, shown, inspected);
    this.playback.update(now, shown, blockedReason);
    this.gauge.update(this.actions.camera, this.session.facts !== undefined);
    this.legend.update(this.choices.mode, this.session.facts);
    this.lazy.gallery?.update(blockedReason);
    this.lazy.tools?.refresh(this.actions.camera.last, blockedReason);
    if (now - this.lastFigures < figurePeriod) return;
    this.lastFigures = now;
    this.header.update(now, graphics);
    this.status.update(now, clock.imagesPerSecond, this.session.state.current);
    this.panel.stream.update(this.session, now);
    this.panel.charts.update(this.session.samples);
  }

  recordingChanged(recording: Recording, before: Recording | undefined): void {
    const end = recordingEnd(recording, before);
    if (!end) return;
    const path = `recordings/${encodeURIComponent(end.file)}`;
    const fetched = (use: (file: Blob) => void): void => void this.fetchFile(path, end.file, use);
    const actions = {
      Download: () => fetched((file) => this.files.give(file, end.file)),
      Open: () => fetched((file) => this.actions.play(new File([file], end.file))),
    };
    this.toasts.show(end.title, end.text, end.failed ? "bad" : "good", { stay: longStay, actions });
  }

  /** Fetches a file of the server. `name`: for the user. */
  private async fetchFile(path: string, name: string, use: (file: Blob) => void): Promise<void> {
    try {
      use(await this.actions.fetchFile(path));
    } catch (error) {
      this.toasts.show(name, sentence(error instanceof Error ? error.message : String(error)), "bad");
    }
  }

  private async savePicture(width: number, height: number): Promise<void> {
    // A picture that was cancelled still ends its tile.
    if (this.makesPicture) return this.toasts.once("Not saved", "Another picture is being made.", "plain");
    this.makesPicture = true;
    const { facts } = this.session;
    this.picture = 0;
    const progress = (share: number): boolean => {
      if (this.picture !== undefined) this.picture = share;
      return this.picture !== undefined;
    };
    try {
      const file = await this.actions.picture(width, height, progress);
      if (file) this.files.give(file, fileNameOf(facts?.name ?? "", ".png"));
    } catch (error) {
      this.toasts.show("Picture not saved", sentence(error instanceof Error ? error.message : String(error)), "bad");
    }
    this.picture = undefined;
    this.makesPicture = false;
  }

  saved(file: Blob, name: string): void {
    this.files.give(file, name);
    this.toasts.show("Saved", `Open ${name} on this page, or play it with spherule play.`, "good", { stay: longStay });
  }

  eventReceived(event: Event): void {
    const announcement = announcementOf(event, this.session.playing);
    if (announcement) this.toasts.show(announcement.who, announcement.what, "plain", { topic: announcement.who });
    else this.toasts.show("Server", event.text, "plain", { stay: longStay });
  }

  private showNotices(graphics: Graphics, now: number): void {
    const { state, refusal, farewell, status, divergence, facts, playing } = this.session;
    const outside = playing ? 0 : this.outside.due(status?.outside ?? 0);
    const more = { outside, link: this.links.wanted, diverged: divergence !== undefined, known: facts !== undefined };
    const notices = noticesFor({ state, graphics, host: this.site.server.host, refusal, farewell, ...more });
    this.notices.update(notices, now, this.steering.blockedReason);
  }

  private dismiss(id: Notice["id"]): void {
    if (id === "outside") this.outside.dismiss(this.session.status?.outside ?? 0);
    else if (id === "link") this.links.dismiss();
    else this.session.divergence = undefined;
  }

  private act(action: NoticeAction): void {
    if (action === "reload") location.reload();
    if (action === "reset") void this.commands.reset();
    if (action === "drop") this.panel.dropNow();
    if (action === "load") void this.commands.load(this.links.wanted?.name ?? "");
    if (action === "choose") void this.lazy.showGallery(this.steering.blockedReason);
  }

  /** Measures where the elements cover the canvas. They move only if one of them or the page changes its size. */
  private observe(elements: HTMLElement[]): void {
    const observer = new ResizeObserver(() => {
      const { left: x, top: y } = this.site.view.getBoundingClientRect();
      this.covered = elements
        .map((element) => element.getBoundingClientRect())
        .filter(({ width, height }) => width > 0 && height > 0)
        .map(({ left, top, right, bottom }) => ({
          left: left - x,
          top: top - y,
          right: right - x,
          bottom: bottom - y,
        }));
      this.actions.wake();
    });
    for (const element of [this.container, ...elements]) observer.observe(element);
  }

  private toggle(): void {
    void (this.session.paused ? this.commands.resume() : this.commands.pause());
  }

  private showPanel(open: boolean): void {
    this.container.classList.toggle("panel-closed", !open);
  }
}
