import type { Diagnostics, Dial, Event, Settings, Welcome } from "../gen/spherule/v1/control_pb";
import type { Status } from "../gen/spherule/v1/frame_pb";
import type { FromWorker, LinkState, State } from "../connection/messages";
import { sharedNow } from "../clock";
import { factsOf } from "./facts";
import type { Facts } from "./facts";
import { States } from "./states";
import { Traffic } from "./traffic";

export interface SessionEvents {
  welcomed(welcome: Welcome): void;
  sceneChanged(facts: Facts, before: Facts | undefined): void;
  settled(settings: Settings): void;
  dialled(dial: Dial): void;
  diagnosed(diagnostics: Diagnostics): void;
  happened(event: Event): void;
  broken(reason: string): void;
}

/** What the page knows of the server and its world. */
export class Session {
  link: LinkState = "connecting";
  linkReason = "";
  retryAt = 0; // ms, as sharedNow() says
  welcome: Welcome | undefined;
  facts: Facts | undefined;
  settings: Settings | undefined;
  status: Status | undefined;
  dial: Dial | undefined;
  diagnostics: Diagnostics | undefined;
  lastArrival = 0; // ms, of a frame of this epoch
  frames = 0; // taken since the page was loaded
  skipped = 0; // that newer ones replaced on the way
  readonly traffic = new Traffic();
  readonly states: States;
  private sequence = 0;
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
        this.link = message.state;
        this.linkReason = message.reason ?? "";
        this.retryAt = sharedNow() + (message.retryIn ?? 0);
        this.sequence = 0;
        this.fresh ||= message.state === "open";
        break;
      case "welcome":
        this.welcome = message.welcome;
        this.events.welcomed(message.welcome);
        break;
      case "scene": {
        const before = this.facts;
        this.facts = factsOf(message.facts);
        if (this.fresh) this.states.begin(-1); // another server may use the same numbers for other epochs
        this.fresh = false;
        this.states.begin(this.facts.epoch);
        this.events.sceneChanged(this.facts, before);
        break;
      }
      case "settings":
        this.settings = message.settings;
        this.events.settled(message.settings);
        break;
      case "frame": {
        const { arrival, bytes, sequence, status } = message.frame;
        this.traffic.add(arrival, bytes);
        if (!this.states.push(message.frame)) break;
        this.frames += 1;
        this.lastArrival = arrival;
        if (this.sequence > 0) this.skipped += Math.max(0, sequence - this.sequence - 1);
        this.sequence = sequence;
        this.status = status;
        break;
      }
      case "dial":
        this.dial = message.dial;
        this.events.dialled(message.dial);
        break;
      case "diagnostics":
        this.diagnostics = message.diagnostics;
        this.events.diagnosed(message.diagnostics);
        break;
      case "event":
        this.events.happened(message.event);
        break;
      case "broken":
        this.events.broken(message.reason);
        break;
      case "result":
        break; // the link has given it to whoever waits for it
    }
  }

  get paused(): boolean {
    return this.status?.paused ?? this.settings?.paused ?? false;
  }

  /** 0 for a live picture to 1 for one that nothing has refreshed for a while; `now` as sharedNow() says. */
  staleness(now: number): number {
    if (!this.facts) return 0;
    const silent = now - this.lastArrival;
    const grace = this.link === "open" ? (this.paused ? Infinity : 5000) : 400;
    return Math.min(1, Math.max(0, (silent - grace) / 600));
  }
}
