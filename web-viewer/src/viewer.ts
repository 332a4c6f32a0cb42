import { effect } from "@preact/signals-core";
import { Camera } from "./camera/camera";
import { listen } from "./camera/gestures";
import { rayThrough } from "./camera/ray";
import type { View } from "./camera/view";
import { DrawClock, sharedNow } from "./clock";
import { Admission } from "./connection/admission";
import { Commands, ReportLog } from "./connection/commands";
import type { PushRay, Report } from "./connection/commands";
import { fetchFile } from "./connection/download";
import { Link } from "./connection/link";
import { TokenStore } from "./connection/token_store";
import { saveViewRequest } from "./connection/view_request";
import { ViewSubscription } from "./connection/view_subscription";
import { sentence } from "./format";
import type { Choices, ToolName } from "./ui/choices";
import { everything } from "./model/cut";
import { ColourRanges } from "./model/colour_ranges";
import { Session } from "./model/session";
import { shownPosition } from "./model/positions";
import type { Shown } from "./model/states";
import { Trace } from "./model/trace";
import { markFirst } from "./perf_marks";
import { Canvas } from "./renderer/canvas";
import type { DrawState } from "./renderer/draw_state";
import { h } from "./ui/dom";
import { addHost } from "./ui/hosts";
import { Page } from "./ui/page";
import { Ticker } from "./ticker";
import { refusalText } from "./ui/refusals";
import { longStay } from "./ui/toasts";

const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
const pictureHeight = 720; // CSS px: lines in saved pictures are as wide as in a page of this height
const mostTurning = 10_000; // spheres of which the page shows the rotation unasked
const reportPeriod = 1000; // ms between reports of the draw rate to the worker

/** The values that an image depends on, to find whether it would be another one. Allocates nothing per image. */
class Content {
  private next = new Float64Array(64);
  private kept = new Float64Array(64);
  private length = 0;
  private nextNames: unknown[] = [];
  private keptNames: unknown[] = [];
  private names = 0;
  private known = false; // `kept` and `keptNames` hold the values of an image

  begin(): void {
    this.length = this.names = 0;
  }

  /** At most 64 numbers. */
  add(value = NaN): this {
    this.next[this.length++] = value;
    return this;
  }

  addAll(values: ArrayLike<number>): this {
    for (let k = 0; k < values.length; k++) this.next[this.length++] = values[k] as number;
    return this;
  }

  addName(value: unknown): this {
    this.nextNames[this.names++] = value;
    return this;
  }

  get changed(): boolean {
    if (!this.known) return true;
    for (let k = 0; k < this.length; k++) if (!Object.is(this.kept[k], this.next[k])) return true;
    for (let k = 0; k < this.names; k++) if (this.keptNames[k] !== this.nextNames[k]) return true;
    return false;
  }

  /** The image has been drawn. */
  keep(): void {
    const { kept, keptNames } = this;
    this.kept = this.next;
    this.next = kept;
    this.keptNames = this.nextNames;
    this.nextNames = keptNames;
    this.known = true;
  }

  /** The image must be drawn again. */
  forget(): void {
    this.known = false;
  }
}

/**
 * Connects the parts: messages of the server go to the canvas and the page, and the user's actions go to the server.
 */
export class Viewer {
  readonly camera = new Camera();
  readonly reports = new ReportLog();
  readonly session: Session;
  readonly canvas: Canvas;
  readonly page: Page;
  private readonly commands: Commands;
  private readonly link: Link;
  private readonly admission: Admission;
  private readonly ranges = new ColourRanges();
  private readonly clock = new DrawClock();
  private readonly ticker = new Ticker((now) => this.tick(now));
  private readonly subscription: ViewSubscription;
  private tokenNote = ""; // message of the next token dialog
  private readonly trace = new Trace(); // of the selected sphere
  private tracked: number | undefined; // id of the sphere that the camera was last given
  private lastReport = 0; // ms: when the worker was last given the draw rate
  private readonly image = new Content(); // of the canvas
  private clicked: { x: number; y: number; tool: ToolName } | undefined; // a click that waits

  /** `url`: of the server's stream. `own`: see Site. */
  constructor(
    private readonly host: HTMLElement,
    private readonly choices: Choices,
    private readonly url: string,
    own: boolean,
  ) {
    const element = h("canvas", {
      class: "view empty",
      "data-testid": "picture",
      tabindex: "0",
      role: "application",
      "aria-label": "The simulated spheres. Arrow keys turn the view, + and − zoom",
    });
    host.append(h(host.closest("main, section") ? "div" : "main", {}, element));
    addHost(host);
    const server = new URL(".", url.replace("ws", "http"));
    this.canvas = new Canvas(element, choices.quality, () => this.redraw());
    this.link = new Link(new Worker("worker.js"), (message) => {
      this.session.handle(message);
      this.ticker.request();
    });
    this.subscription = new ViewSubscription({ ...choices.view }, (view) => this.link.requestView(view));
    this.session = this.createSession();
    this.admission = new Admission(new TokenStore(url, () => sessionStorage), {
      tokenRequired: (error) => {
        this.page.prompt.ask(error ? sentence(error) : this.tokenNote);
        this.tokenNote = "";
      },
      tokenSettled: () => this.page.prompt.close(),
      reconnect: (token) => this.link.reconnect(token),
      tokenHeld: (held) => (this.session.tokenHeld = held),
    });
    this.commands = new Commands(
      this.link,
      (report) => this.report(report),
      (command) => this.session.isLocal(command),
      (command) => this.page.steering.blocked(command),
    );
    this.page = new Page({ host, view: element, server, own }, this.session, this.commands, this.ranges, choices, {
      retry: () => (this.session.link === "locked" ? this.page.prompt.ask("") : this.link.retry()),
      present: () => this.link.showPresent(),
      save: () => this.link.save(),
      fetchFile: (path) => fetchFile(path, server, this.admission.token),
      click: (x, y) => this.click(x, y),
      play: (recording) => this.link.open(recording),
      submitToken: (text) => this.admission.submit(text),
      forgetToken: () => this.admission.forget(),
      sendControl: (message) => this.link.sendControl(message),
      picture: (width, height, progress) => this.picture(width, height, progress),
      viewRequested: (view) => {
        saveViewRequest(view, () => localStorage);
        this.subscription.request(view);
      },
      wake: () => this.ticker.wake(),
      camera: this.camera,
    });
    effect(() => {
      this.canvas.setTheme(choices.theme);
      this.redraw();
    });
    effect(() => {
      this.canvas.choose(choices.quality);
      this.redraw();
    });
    effect(() => {
      this.canvas.hide(choices.cut.hidden);
      this.redraw();
    });
    this.listenToGestures(element);
  }

  /** `tokenInAddress`: the page's address had a token, which was removed. */
  start(tokenInAddress: boolean): void {
    if (tokenInAddress) {
      this.tokenNote = "The token in the address was ignored, because others can see addresses.";
      const text = "Do not put tokens in addresses: others can see them.";
      this.page.toasts.show("Token ignored", text, "bad", { stay: longStay });
    }
    this.link.connect(this.url, this.subscription.view, this.admission.begin());
    const resize = (): void => {
      const { clientWidth, clientHeight } = this.host;
      this.camera.resize(clientWidth, clientHeight);
      this.canvas.resize(clientWidth, clientHeight);
      this.redraw();
    };
    window.addEventListener("resize", resize); // also when the device's pixels change
    new ResizeObserver(resize).observe(this.host);
    resize();
    document.addEventListener("visibilitychange", () => this.setVisible(!document.hidden));
    this.setVisible(!document.hidden);
    this.ticker.start();
  }

  /** The place of the sphere that the image shows at a point of the canvas (CSS pixels). */
  placeAt(x: number, y: number): number | undefined {
    return this.canvas.placeAt(x, y);
  }

  private createSession(): Session {
    return new Session((state) => this.link.recycle(state), {
      linkChanged: (change) => this.admission.linkChanged(change),
      welcomed: () => this.admission.welcomed(),
      // docs/protocol.md lists the values that come from another scene, and the choices that stay.
      sceneChanged: (facts, another) => {
        this.camera.look(facts, !another);
        this.canvas.setFacts(facts);
        if (another) {
          this.ranges.reset();
          this.page.inspector.selection.clear();
          this.page.panel.sceneChanged(facts);
        } else {
          this.page.inspector.selection.follow(facts.population);
        }
        this.page.links.sceneShown(facts);
        this.redraw();
      },
      orderChanged: (order) => this.canvas.setOrder(order),
      populationChanged: ({ population }, changed) => {
        this.canvas.updatePopulation(changed);
        this.page.inspector.selection.follow(population);
        this.redraw();
      },
      recordingChanged: (recording, before) => this.page.recordingChanged(recording, before),
      eventReceived: (event) => this.page.eventReceived(event),
      saved: (file, name) => this.page.saved(file, name),
      told: (title, text) => this.page.toasts.show(title, text, "bad", { stay: longStay }),
      messageUnreadable: (reason) => this.page.toasts.show("Unreadable message", reason, "bad"),
    });
  }

  private report(report: Report): void {
    this.reports.add(report);
    const { name, outcome, text, quiet } = report;
    const { toasts } = this.page;
    if (outcome.case === "refused") toasts.show(name, refusalText(outcome.value), "bad", { detail: text });
    else if (outcome.case === "lost") toasts.show(name, text, "bad");
    else if (!quiet) toasts.show(name, text, "good");
  }

  /** The next tick draws an image. */
  private redraw(): void {
    this.image.forget();
    this.ticker.wake();
  }

  /** Returns whether it has drawn an image. */
  private tick(now: number): boolean {
    const { session, camera, choices } = this;
    const wall = performance.timeOrigin + now;
    this.clock.tick(now);
    if (session.facts) this.subscription.setQuantity(this.page.quantity);
    const turns = this.turns;
    this.subscription.setSpins(turns);
    const shown = session.states.shown(wall);
    this.ranges.update(choices.mode, session.facts, shown, now);
    this.follow(shown);
    camera.cover(this.page.covered);
    camera.advance(this.clock.elapsed, reducedMotion.matches);
    const state = this.stateOf(camera.view(), session.staleness(wall), turns);
    const { image } = this;
    image.begin();
    image.add(shown?.from.sequence).add(shown?.to.sequence).add(shown?.mix);
    image.addAll(state.view.eye).addAll(state.view.toClip).addAll(state.kept.normal);
    image.add(state.kept.offset);
    image.add(state.range[0]).add(state.range[1]).add(state.selected).add(state.dim);
    image.addName(state.mode).addName(state.trace).addName(choices.theme).addName(choices.quality).addName(turns);
    const draws = image.changed && !session.awaitsState(wall);
    const drew = draws && this.canvas.draw(shown, state, this.clock.sinceDrawn);
    if (drew) {
      image.keep();
      this.clock.drew();
      if (shown) markFirst("drawn");
    }
    const { clicked } = this;
    if (clicked && session.newest && (drew || !draws)) {
      if (clicked.tool === choices.tool) this.click(clicked.x, clicked.y);
      else this.clicked = undefined;
    }
    this.page.lazy.tools?.update(state.view, shown);
    this.reportDrawRate(now);
    this.page.update(wall, shown, this.clock, this.canvas.graphics);
    return drew;
  }

  /** Whether spheres are drawn with a pattern that turns with them. */
  private get turns(): boolean {
    const { session, choices, canvas } = this;
    if (!session.settings?.rotates || choices.rotation === "hidden") return false;
    const few = (session.facts?.population.count ?? Infinity) <= mostTurning;
    return choices.rotation === "shown" || (canvas.full && few);
  }

  private stateOf(view: View, dim: number, turns: boolean): DrawState {
    const { session, choices } = this;
    return {
      view,
      kept: session.facts ? choices.cut.halfSpace(session.facts) : everything,
      mode: choices.mode,
      turns,
      range: this.ranges.of(choices.mode, session.facts),
      trace: choices.trace ? this.trace : undefined,
      selected: this.page.inspector.selection.place,
      dim,
    };
  }

  /** Makes a picture of the present view (px), as PNG. See Canvas.picture(). */
  private async picture(
    width: number,
    height: number,
    progress: (share: number) => boolean,
  ): Promise<Blob | undefined> {
    const view = this.camera.viewFor((width * pictureHeight) / height, pictureHeight);
    const shown = this.session.states.shown(sharedNow());
    const picture = await this.canvas.picture(shown, this.stateOf(view, 0, this.turns), width, height, progress);
    this.redraw();
    return picture;
  }

  /** Follows the selected sphere with the camera, and notes its path. */
  private follow(shown: Shown | undefined): void {
    const { session, camera, trace } = this;
    const { id, place, followed } = this.page.inspector.selection;
    const { facts } = session;
    trace.update(facts, shown, id, place);
    if (id !== this.tracked || !followed) camera.track(undefined);
    this.tracked = id;
    if (!followed || !facts || !shown || place === undefined) return;
    camera.track(shownPosition(facts, shown, place));
  }

  /** Call when the page is hidden or shown. */
  private setVisible(visible: boolean): void {
    this.subscription.setVisible(visible);
    if (visible) this.session.resume(sharedNow());
    else this.link.reportDrawRate(0);
  }

  private async push(ray: PushRay, sphere: number | undefined): Promise<void> {
    const { panel } = this.page;
    if (panel.checkImpulse()) panel.pushed(await this.commands.push(ray, sphere, this.choices.impulse));
  }

  private reportDrawRate(now: number): void {
    if (now - this.lastReport < reportPeriod) return;
    this.lastReport = now;
    this.link.reportDrawRate(this.clock.drawRate);
  }

  private listenToGestures(element: HTMLCanvasElement): void {
    const { camera } = this;
    listen(element, {
      orbit: (dx, dy) => camera.orbit(dx, dy),
      pan: (dx, dy) => camera.pan(dx, dy),
      zoom: (factor, x, y) => camera.zoom(factor, x, y),
      click: (x, y) => this.click(x, y),
      grab: (x, y) => this.page.lazy.tools?.grab(x, y, this.placeAt(x, y)) ?? false,
      drag: (x, y) => this.page.lazy.tools?.drag(x, y),
      letGo: () => this.page.lazy.tools?.letGo(),
    });
  }

  /**
   * `x`, `y`: CSS pixels on the canvas. A click into the image of an earlier scene, or before the tool is loaded, waits
   * for an image of this scene, or for the tool.
   */
  private click(x: number, y: number): void {
    this.clicked = undefined;
    const { tool } = this.choices;
    const loads = tool === "drop" && !this.page.lazy.tools;
    if (loads || (this.session.facts && !this.session.newest)) {
      this.clicked = { x, y, tool };
      return;
    }
    const place = this.placeAt(x, y);
    const population = this.session.facts?.population;
    const ray = rayThrough(this.camera.last, x, y);
    if (tool === "push") void this.push(ray, place === undefined ? undefined : population?.idOf(place));
    else if (tool === "drop") this.page.lazy.tools?.drop(ray, place);
    else this.page.inspector.selection.select(population, place);
  }
}
