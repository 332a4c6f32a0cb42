import { batch, computed } from "@preact/signals-core";
import { sharedNow } from "../clock";
import { isLocal } from "../connection/messages";
import type { CommandCase, DrawOrder, FromWorker, LinkChange, LinkState } from "../connection/messages";
import type { PastRange, Received, ReplayState } from "../connection/messages";
import { Event_Kind } from "../gen/spherule/v1/control_pb";
import type {
  Change,
  Control,
  Event,
  Recording,
  Settings,
  Stream,
  Timeline,
  Welcome,
} from "../gen/spherule/v1/control_pb";
import type { SceneParts } from "../gen/spherule/v1/scene_parts_pb";
import type { Diagnostics, Dial } from "../gen/spherule/v1/diagnostics_pb";
import type { Population as PopulationChange, SceneFacts } from "../gen/spherule/v1/facts_pb";
import type { Status } from "../gen/spherule/v1/frame_pb";
import { observed } from "../observed";
import { markFirst } from "../perf_marks";
import { DelayMeter } from "./delay";
import { factsOf } from "./facts";
import type { Facts } from "./facts";
import { pageStateOf } from "./page_state";
import type { PageState } from "./page_state";
import type { TimeAdvance } from "./playout";
import { differences, PendingChanges, Population } from "./population";
import type { Run } from "./population";
import { Samples } from "./samples";
import { States } from "./states";
import type { State } from "./states";
import { Traffic } from "./traffic";

const farewells = [Event_Kind.DRAINING, Event_Kind.DEVICE_LOST]; // the last events of a server
const firstStateTimeout = 1000; // ms to wait for the first state of a scene before drawing without it

/** The content of the timeline: a recording, or the last seconds of a simulation (`live`). Times in s. */
export interface Track {
  file: string;
  begin: number;
  end: number;
  frames: number;
  flaw: string; // why the recording ends early
  live: boolean;
}

export interface SessionEvents {
  linkChanged(change: LinkChange): void;
  welcomed(welcome: Welcome): void;
  /** `another`: it is another scene than before. Then what belongs to the scene starts from the scene again. */
  sceneChanged(facts: Facts, another: boolean): void;
  orderChanged(order: DrawOrder): void;
  /** `changed`: the places whose sphere has changed. */
  populationChanged(facts: Facts, changed: Run[]): void;
  eventReceived(event: Event): void;
  recordingChanged(recording: Recording, before: Recording | undefined): void;
  messageUnreadable(reason: string): void;
  /** A recording of the past has been written. */
  saved(file: Blob, name: string): void;
  /** Something has failed. */
  told(title: string, text: string): void;
}

/** The page's end of its session: all that it knows of the server and the simulation. */
export class Session {
  @observed accessor link: LinkState = "connecting";
  @observed accessor linkReason = "";
  @observed accessor attempted = false; // an attempt to connect has failed, or a connection has ended
  @observed accessor refusal = ""; // why the server refused this page; empty if it did not
  @observed accessor retryAt = 0; // ms, as sharedNow() counts
  @observed accessor silentSince: number | undefined; // ms: the connection is open, but the server does not answer
  @observed accessor farewell = ""; // why the server ended; empty once a server answers
  @observed accessor deviceLost = false; // with `farewell`: the server's device is lost
  /** Positions became non-finite, and the world has not gone on since then. */
  @observed accessor divergence: Event | undefined;
  @observed accessor tokenHeld = false; // this tab has a token for the server
  @observed accessor welcome: Welcome | undefined;
  @observed accessor facts: Facts | undefined;
  @observed accessor revision = 0; // grows with each change of the population of these facts
  @observed accessor settings: Settings | undefined;
  @observed accessor parts: SceneParts | undefined; // fields, emitters and materials; undefined: unknown
  @observed accessor status: Status | undefined;
  @observed accessor dial: Dial | undefined;
  @observed accessor diagnostics: Diagnostics | undefined;
  @observed accessor stream: Stream | undefined; // that the server sends; undefined: unknown
  @observed accessor timeline: Timeline | undefined; // of the recording that is played; undefined: the server simulates
  /** Undefined: every client may send commands, or the holder is unknown. */
  @observed accessor control: Control | undefined;
  @observed accessor recording: Recording | undefined; // of the server; undefined: it cannot record
  @observed accessor change: Change | undefined; // a long command in progress
  @observed accessor past: PastRange | undefined; // that the page can show again; undefined: none
  @observed accessor replay: ReplayState | undefined; // undefined: the page shows what the server sends
  frames = 0; // states received since the page was loaded
  lost = 0; // frames that could not be decoded since the page was loaded
  readonly traffic = new Traffic();
  readonly delay = new DelayMeter();
  readonly samples = new Samples(); // of the present run
  readonly states: States;
  private readonly computedState = computed(() => pageStateOf(this));
  private readonly computedPaused = computed(() => this.isPaused());
  private lastArrival = 0; // ms, of a frame of this epoch
  private epochStart = 0; // ms: when the facts of this epoch arrived
  private restarts = true; // the next scene does not continue the present one: it is of another connection or time
  private pending = new PendingChanges(0); // of the population

  /** `drop` is given each state that will not be shown any more. */
  constructor(
    private readonly drop: (state: State) => void,
    private readonly events: SessionEvents,
  ) {
    this.states = new States(drop);
  }

  handle(message: FromWorker): void {
    // Frames are frequent, and a batch allocates.
    if (message.kind === "frame") this.take(message);
    else batch(() => this.take(message));
  }

  private take(message: FromWorker): void {
    switch (message.kind) {
      case "link":
        this.linkChanged(message);
        break;
      case "silent":
        this.silentSince = message.since;
        break;
      case "welcome":
        this.farewell = "";
        this.welcome = message.welcome;
        this.refusal = "";
        this.timeline = undefined; // it may be another server
        this.recording = undefined;
        this.events.welcomed(message.welcome);
        break;
      case "scene":
        markFirst("scene");
        this.restarts ||= message.jump ?? false;
        this.sceneReceived(message.facts);
        break;
      case "population":
        this.populationReceived(message.population);
        break;
      case "settings":
        this.settings = message.settings;
        if (!message.settings.paused) this.divergence = undefined;
        break;
      case "parts":
        this.parts = message.parts;
        break;
      case "order":
        this.events.orderChanged(message.order);
        break;
      case "frame":
        this.frameReceived(message.frame);
        break;
      case "timeline":
        this.timeline = message.timeline;
        break;
      case "recording": {
        const before = this.recording;
        this.recording = message.recording;
        this.events.recordingChanged(message.recording, before);
        break;
      }
      case "control":
        this.control = message.control;
        break;
      case "change":
        this.change = message.change.what ? message.change : undefined;
        break;
      case "stream":
        this.stream = message.stream;
        break;
      case "lost":
        this.lost = message.count;
        break;
      case "past":
        this.past = message.past;
        break;
      case "replay":
        if (this.replay?.source === "file" && !message.replay) this.timeline = undefined;
        this.replay = message.replay;
        break;
      case "dial":
        this.dial = message.dial;
        break;
      case "diagnostics":
        this.diagnostics = message.diagnostics;
        this.samples.add(message.diagnostics, this.status?.realTimeFactor, this.delay.newest);
        break;
      case "event":
        this.eventReceived(message.event);
        break;
      case "saved":
        this.events.saved(message.file, message.name);
        break;
      case "told":
        this.events.told(message.title, message.text);
        break;
      case "unreadable":
        this.events.messageUnreadable(message.reason);
        break;
      case "result":
        break; // handled by the link
    }
  }

  /** Call when the page is shown again: its state may be old, and the next one is about to arrive. */
  resume(now: number): void {
    this.lastArrival = Math.max(this.lastArrival, now);
  }

  /** Whether the first state of the scene is about to arrive, so that drawing without it is not worth while. */
  awaitsState(now: number): boolean {
    const spheres = this.facts?.population.count ?? 0;
    return this.live && !this.newest && spheres > 0 && now - this.epochStart < firstStateTimeout;
  }

  /** The newest state of this epoch. */
  get newest(): State | undefined {
    return this.states.newest;
  }

  /** The state of the connection; "silent": it is open, but the server does not answer. */
  get connection(): LinkState | "silent" {
    return this.silentSince === undefined ? this.link : "silent";
  }

  /** Spheres in the scene; undefined: no scene is known yet. */
  get spheres(): number | undefined {
    return this.revision >= 0 ? this.facts?.population.count : undefined; // reads `revision`, to follow it
  }

  /** Whether the server plays a recording. */
  get playing(): boolean {
    return this.timeline !== undefined;
  }

  get live(): boolean {
    return this.connection === "open";
  }

  /** The situation of the page. */
  get state(): PageState {
    return this.computedState.value;
  }

  get paused(): boolean {
    return this.computedPaused.value;
  }

  private isPaused(): boolean {
    if (this.replay) return this.replay.paused;
    const setting = this.settings?.paused;
    return (this.timeline ? setting : (this.status?.paused ?? setting)) ?? false;
  }

  /** Undefined without a timeline. */
  get track(): Track | undefined {
    const { timeline, past } = this;
    if (timeline) return { ...timeline, frames: Number(timeline.frames), live: false };
    return past && { ...past, file: "", flaw: "", live: true };
  }

  /** Mean time on the timeline between two frames (s); 0 without a timeline. */
  get spacing(): number {
    const { track } = this;
    return track ? (track.end - track.begin) / Math.max(1, track.frames - 1) : 0;
  }

  /** Whether the page may carry out the command itself, whoever controls the simulation. */
  isLocal(command: CommandCase): boolean {
    return isLocal(command, this.replay, this.past);
  }

  /** How stale the image is: 0 for a live one, 1 for one that has not been refreshed for a while. `now`: ms. */
  staleness(now: number): number {
    if (!this.facts || this.replay) return 0;
    const age = now - this.lastArrival;
    const rests = this.paused || this.change !== undefined; // a long command may stop the world
    const grace = this.live ? (rests ? Infinity : Math.max(5000, 2 * this.interval)) : 400;
    return Math.min(1, Math.max(0, (age - grace) / 600));
  }

  /** Time between two states that follow each other at the requested speed (ms). */
  private get interval(): number {
    const { step = 0, speed = 0 } = this.settings ?? {};
    return speed > 0 ? (1000 * (this.timeline ? this.spacing : step)) / speed : 0;
  }

  private eventReceived(event: Event): void {
    if (farewells.includes(event.kind)) {
      this.farewell = event.text;
      this.deviceLost = event.kind === Event_Kind.DEVICE_LOST;
    } else if (event.kind === Event_Kind.NON_FINITE) {
      this.divergence = event;
    } else {
      this.events.eventReceived(event);
    }
  }

  private sceneReceived(scene: SceneFacts): void {
    const before = this.facts;
    const again = !this.restarts && scene.epoch === before?.epoch;
    if (again && this.newest && scene.population > before.population.number) {
      return this.pending.replace(scene.population, () => this.replacePopulation(scene));
    }
    if (again) this.pending.replace(scene.population);
    else this.pending = new PendingChanges(scene.population);
    if (this.restarts) this.states.begin(-1); // another server may give the same number to another epoch
    this.restarts = false;
    this.facts = factsOf(scene);
    const another = this.facts.name !== before?.name;
    if (another) this.divergence = undefined;
    if (another) this.samples.clear();
    if (this.states.epoch !== this.facts.epoch) this.epochStart = sharedNow();
    this.states.begin(this.facts.epoch);
    this.events.sceneChanged(this.facts, another);
  }

  private replacePopulation(scene: SceneFacts): Run[] {
    const { facts } = this;
    if (!facts) return [];
    const before = facts.population;
    facts.population = new Population(scene);
    this.revision += 1;
    return differences(before, facts.population);
  }

  /** Frames of earlier populations may still arrive: the change waits for the first frame that includes it. */
  private populationReceived(change: PopulationChange): void {
    if (change.epoch !== this.facts?.epoch) return;
    try {
      this.pending.add(change.number, () => this.facts?.population.apply(change) ?? []);
    } catch (error) {
      this.events.messageUnreadable(error instanceof Error ? error.message : String(error));
    }
  }

  private frameReceived(frame: Received): void {
    const { arrival, ready, status } = frame;
    this.traffic.add(frame);
    this.delay.add(arrival, ready);
    if (!this.isDescribed(frame)) return this.drop(frame);
    const changed = this.pending.applyTo(frame.population);
    if (changed) this.states.carryBack(frame, changed);
    if (changed && this.facts) {
      this.revision += 1;
      this.events.populationChanged(this.facts, changed);
    }
    this.states.push(frame, this.timeAdvance);
    markFirst("arrived", arrival);
    markFirst("decoded");
    this.frames += 1;
    if (frame.step === 0) this.divergence = undefined; // the world was reset
    this.lastArrival = arrival;
    this.status = status;
  }

  /** Whether the facts and the changes that have arrived tell which spheres are in the frame. */
  private isDescribed({ epoch, population }: Received): boolean {
    const { facts } = this;
    if (!facts || epoch !== this.states.epoch) return false;
    return population >= facts.population.number && population <= this.pending.newest;
  }

  private linkChanged(change: LinkChange): void {
    markFirst(change.state, change.at);
    this.link = change.state;
    this.linkReason = change.reason ?? "";
    this.retryAt = sharedNow() + (change.retryIn ?? 0);
    this.silentSince = undefined;
    this.attempted ||= change.state === "waiting";
    if (change.state === "waiting") this.refusal = change.refused ? this.linkReason : "";
    if (change.state !== "open") this.stream = this.control = this.change = undefined;
    this.delay.reset();
    this.restarts ||= change.state === "open";
    this.events.linkChanged(change);
  }

  private get timeAdvance(): TimeAdvance {
    const { settings, paused, timeline, replay } = this;
    const speed = settings?.speed || Infinity;
    const spacing = timeline || replay ? this.spacing * (timeline ? 1 : speed) : 0;
    return { speed, paused, spacing };
  }
}
