import { Camera } from "./camera/camera";
import { listen } from "./camera/gestures";
import { pick, rayThrough } from "./camera/ray";
import { AutoRange } from "./colour/range";
import { Admission } from "./connection/admission";
import { Commands } from "./connection/commands";
import type { Report } from "./connection/commands";
import { Link } from "./connection/link";
import { TokenStore } from "./connection/token_store";
import { Watch } from "./connection/watch";
import { keep } from "./connection/wish";
import { Reports } from "./hook";
import { markFirst } from "./marks";
import { paletteFor } from "./renderer/palette";
import { Stage } from "./renderer/stage";
import { highSpeed } from "./scene/positions";
import { Session } from "./scene/session";
import type { Shown } from "./scene/states";
import { Clock, sharedNow } from "./clock";
import { sentence } from "./ui/format";
import { Page } from "./ui/page";
import type { Choices } from "./ui/panel";
import { longStay } from "./ui/toasts";

/** Joins the parts: what comes from the server goes to the picture and the page, what the person does goes back. */
export class Viewer {
  readonly camera = new Camera();
  readonly reports = new Reports();
  readonly session: Session;
  readonly stage: Stage;
  private readonly commands: Commands;
  readonly page: Page;
  private readonly link: Link;
  private readonly admission: Admission;
  private readonly speeds = new AutoRange(0.1);
  private readonly clock = new Clock();
  private readonly watch: Watch;
  private note = ""; // for who is asked for a token
  private told = 0; // ms: when the worker heard of the drawing
  private drawn = ""; // what the canvas shows
  private measured = -1; // step whose speeds the range knows

  constructor(
    canvas: HTMLCanvasElement,
    place: HTMLElement,
    private readonly choices: Choices,
    private readonly url: string, // of the server
  ) {
    this.stage = new Stage(canvas, choices.quality, () => (this.drawn = ""));
    this.link = new Link(new Worker("worker.js"), (message) => this.session.take(message));
    this.watch = new Watch({ ...choices.view }, (view) => this.link.watch(view));
    this.session = new Session((state) => this.link.recycle(state.positions), {
      linked: (change) => this.admission.changed(change),
      welcomed: (welcome) => {
        this.admission.welcomed();
        this.page.panel.offer(welcome);
      },
      sceneChanged: (facts, before) => {
        const same = facts.name === before?.name;
        this.camera.look(facts, same);
        this.stage.setFacts(facts);
        if (!same) this.speeds.reset();
        if (!same || facts.count < before.count) this.page.inspector.select(undefined);
        this.page.panel.setFacts(facts);
        this.drawn = "";
      },
      settled: (settings) => this.page.panel.settle(settings),
      dialled: (dial) => this.page.panel.setDial(dial),
      diagnosed: (diagnostics) => this.page.panel.diagnose(diagnostics),
      recorded: (recording, before) => this.page.recorded(recording, before),
      happened: ({ text }) => this.page.toasts.show("Server", text, "plain"),
      broken: (reason) => this.page.toasts.show("Unreadable message", reason, "bad"),
    });
    this.admission = new Admission(new TokenStore(url, () => sessionStorage), {
      ask: (wrong) => {
        this.page.prompt.ask(wrong ? sentence(wrong) : this.note);
        this.note = "";
      },
      done: () => this.page.prompt.close(),
      identify: (token) => this.link.identify(token),
      held: (held) => this.page.panel.holdToken(held),
    });
    const report = (report: Report): void => {
      this.reports.add(report);
      const applied = report.outcome.case === "applied";
      if (!applied || !report.quiet) this.page.toasts.show(report.what, report.words, applied ? "good" : "bad");
    };
    this.commands = new Commands(this.link, report, () => this.page.steering.hindered());
    this.page = new Page(place, this.session, this.commands, this.speeds, choices, {
      retry: () => (this.session.link === "locked" ? this.page.prompt.ask("") : this.link.retry()),
      submitToken: (text) => this.admission.submit(text),
      forgetToken: () => this.admission.forget(),
      aboutControl: (wish) => this.link.aboutControl(wish),
      themed: (theme) => this.stage.setTheme(theme),
      qualityChosen: (quality) => this.stage.choose(quality),
      viewWished: (view) => {
        keep(view, () => localStorage);
        this.watch.want(view);
      },
      camera: this.camera,
    });
    this.stage.setTheme(choices.theme);
    this.listen(canvas);
  }

  /** `strayed`: there was a token in the page's address. */
  start(strayed: boolean): void {
    if (strayed) {
      this.note = "The one in the address was not used: tokens do not belong where others may see them.";
      this.page.toasts.show("Token ignored", "Tokens do not belong in addresses, which others may see.", "bad", longStay);
    }
    this.link.connect(this.url, this.watch.view, this.admission.begin());
    const resized = (): void => {
      this.camera.resize(window.innerWidth, window.innerHeight);
      this.stage.resize(window.innerWidth, window.innerHeight);
      this.drawn = "";
    };
    window.addEventListener("resize", resized);
    resized();
    document.addEventListener("visibilitychange", () => this.turned(!document.hidden));
    this.turned(!document.hidden);
    const tick = (now: number): void => {
      this.tick(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /** The sphere that is seen at a place of the page. */
  readonly seenAt = (x: number, y: number): number | undefined => {
    const { facts, states } = this.session;
    const shown = states.shown(sharedNow());
    return facts && shown && pick(facts, shown, rayThrough(this.camera.last, x, y));
  };

  private tick(now: number): void {
    const { session, camera, choices } = this;
    const wall = performance.timeOrigin + now;
    this.clock.tick(now);
    const shown = session.states.shown(wall);
    this.measure(shown, now);
    camera.insets = this.page.insets();
    camera.advance(this.clock.elapsed);
    const paint = {
      view: camera.view(),
      ...paletteFor(choices.mode, session.facts, this.speeds.high),
      selected: this.page.inspector.selected,
      dim: session.staleness(wall),
    };
    const looks = [...paint.view.viewProjection, paint.mode, paint.range, paint.selected, paint.dim, choices.theme, choices.quality];
    const wanted = `${shown?.from.sequence} ${shown?.to.sequence} ${shown?.mix} ${looks.join(" ")}`;
    if (wanted !== this.drawn && !session.awaitsState(wall) && this.stage.draw(shown, paint, this.clock.sinceDrawn)) {
      this.drawn = wanted;
      this.clock.drew();
      if (shown) markFirst("drawn");
    }
    this.tellDrawing(now);
    this.page.update(wall, shown, this.clock.picturesPerSecond, this.stage.contextLost);
  }

  /** The page was hidden, or is shown again. */
  private turned(shown: boolean): void {
    this.watch.show(shown);
    if (shown) this.session.resume(sharedNow());
    else this.link.draws(0);
  }

  private tellDrawing(now: number): void {
    if (now - this.told < 1000) return;
    this.told = now;
    this.link.draws(this.clock.drawRate);
  }

  private measure(shown: Shown | undefined, now: number): void {
    if (!shown || shown.from === shown.to || shown.to.sequence === this.measured) return;
    this.measured = shown.to.sequence;
    this.speeds.update(highSpeed(shown.from, shown.to), now);
  }

  private listen(canvas: HTMLCanvasElement): void {
    const { camera, choices } = this;
    listen(canvas, {
      orbit: (dx, dy) => camera.orbit(dx, dy),
      pan: (dx, dy) => camera.pan(dx, dy),
      zoom: (factor, x, y) => camera.zoom(factor, x, y),
      click: (x, y) => {
        const sphere = this.seenAt(x, y);
        if (choices.push) void this.commands.push(rayThrough(camera.last, x, y), sphere, choices.impulse);
        else this.page.inspector.select(sphere);
      },
    });
  }
}
