import { Event_Kind } from "../gen/spherule/v1/control_pb";
import type { Change, Control, Diagnostics, Dial, Event, Recording, Settings, Stream, Timeline, Welcome } from "../gen/spherule/v1/control_pb";
import type { Status } from "../gen/spherule/v1/frame_pb";
import type { FromWorker, LinkChange, LinkState, State } from "../connection/messages";
import { sharedNow } from "../clock";
import { markFirst } from "../marks";
import { factsOf } from "./facts";
import type { Facts } from "./facts";
import { Lateness } from "./lateness";
import { States } from "./states";
import type { Pace } from "./timeline";
import { Traffic } from "./traffic";

const farewells = [Event_Kind.DRAINING, Event_Kind.DEVICE_LOST];
const soon = 1000; // ms after its facts that the first state of a scene should have come

export interface SessionEvents {
  linked(change: LinkChange): void;
  welcomed(welcome: Welcome): void;
  sceneChanged(facts: Facts, before: Facts | undefined): void;
  settled(settings: Settings): void;
  dialled(dial: Dial): void;
  diagnosed(diagnostics: Diagnostics): void;
  happened(event: Event): void;
  recorded(recording: Recording, before: Recording | undefined): void;
  broken(reason: string): void;
}

/** What the page knows of the server and its world. */
export class Session {
  link: LinkState = "connecting";
  linkReason = "";
  refusal = ""; // why the server turned the page away; empty: it did not, or that is over
  retryAt = 0; // ms, as sharedNow() says
  silentSince: number | undefined; // ms: the connection is open, but the server does not answer
  farewell = ""; // why the server has ended, until one answers again
  welcome: Welcome | undefined;
  facts: Facts | undefined;
  settings: Settings | undefined;
  status: Status | undefined;
  dial: Dial | undefined;
  diagnostics: Diagnostics | undefined;
  stream: Stream | undefined; // what the server sends; undefined: it has not said
  timeline: Timeline | undefined; // what there is to play; undefined: the server simulates
  control: Control | undefined; // who has the controls; undefined: everybody steers, or it is not known yet
  recording: Recording | undefined; // what the server has recorded; undefined: it keeps none
  change: Change | undefined; // a command that takes long and is under way
  lastArrival = 0; // ms, of a frame of this epoch
  private begun = 0; // ms: when its facts came
  frames = 0; // taken since the page was loaded
  lost = 0; // that could not be decoded since then
  readonly traffic = new Traffic();
  readonly lateness = new Lateness();
  readonly states: States;
  private fresh = true; // connected, and no scene has come since

  constructor(
    drop: (state: State) => void,
    private readonly events: SessionEvents,
  ) {
    this.states = new States(drop);
  }

  take(message: FromWorker): void {
    switch (message.kind) {
      case "link":
        markFirst(message.state, message.at);
        this.link = message.state;
        this.linkReason = message.reason ?? "";
        this.retryAt = sharedNow() + (message.retryIn ?? 0);
        this.silentSince = undefined;
        if (message.state === "waiting") this.refusal = message.refused ? this.linkReason : "";
        if (message.state !== "open") this.stream = this.control = this.change = undefined;
        this.lateness.reset();
        this.fresh ||= message.state === "open";
        this.events.linked(message);
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
      case "scene": {
        markFirst("scene");
        const before = this.facts;
        this.facts = factsOf(message.facts);
        if (this.fresh) this.states.begin(-1); // another server may use the same numbers for other epochs
        this.fresh = false;
        if (this.states.epoch !== this.facts.epoch) this.begun = sharedNow();
        this.states.begin(this.facts.epoch);
        this.events.sceneChanged(this.facts, before);
        break;
      }
      case "settings":
        this.settings = message.settings;
        this.events.settled(message.settings);
        break;
      case "frame": {
        const { arrival, ready, status } = message.frame;
        this.traffic.add(message.frame);
        this.lateness.add(arrival, ready);
        if (!this.states.push(message.frame, this.pace)) break;
        markFirst("arrived", arrival);
        markFirst("decoded");
        this.frames += 1;
        this.lastArrival = arrival;
        this.status = status;
        break;
      }
      case "timeline":
        this.timeline = message.timeline;
        break;
      case "recording": {
        const before = this.recording;
        this.recording = message.recording;
        this.events.recorded(message.recording, before);
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
      case "dial":
        this.dial = message.dial;
        this.events.dialled(message.dial);
        break;
      case "diagnostics":
        this.diagnostics = message.diagnostics;
        this.events.diagnosed(message.diagnostics);
        break;
      case "event":
        if (farewells.includes(message.event.kind)) this.farewell = message.event.text;
        else this.events.happened(message.event);
        break;
      case "broken":
        this.events.broken(message.reason);
        break;
      case "result":
        break; // the link has given it to whoever waits for it
    }
  }

  /** The page is looked at again, at `now`: the state that it has may be old, and the next one is on its way. */
  resume(now: number): void {
    this.lastArrival = Math.max(this.lastArrival, now);
  }

  /** The first state of the scene is about to come: a picture without it would only be in its way. */
  awaitsState(now: number): boolean {
    return this.live && !this.states.newest && (this.facts?.count ?? 0) > 0 && now - this.begun < soon;
  }

  /** The page hears from the server. */
  get live(): boolean {
    return this.link === "open" && this.silentSince === undefined;
  }

  get paused(): boolean {
    const said = this.settings?.paused;
    return (this.timeline ? said : (this.status?.paused ?? said)) ?? false;
  }

  /** Mean time between the frames of the recording that is played, s; 0 where none is. */
  get spacing(): number {
    if (!this.timeline) return 0;
    const { begin, end, frames } = this.timeline;
    return (end - begin) / Math.max(1, Number(frames) - 1);
  }

  /** How far time can go on by itself from one state to the next. */
  private get pace(): Pace {
    return { speed: this.settings?.speed || Infinity, paused: this.paused, spacing: this.spacing };
  }

  /** 0 for a live picture to 1 for one that nothing has refreshed for a while; `now` as sharedNow() says. */
  staleness(now: number): number {
    if (!this.facts) return 0;
    const silent = now - this.lastArrival;
    const grace = this.live ? (this.paused ? Infinity : 5000) : 400;
    return Math.min(1, Math.max(0, (silent - grace) / 600));
  }
}
