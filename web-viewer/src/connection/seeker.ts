import type { Outcome } from "./link";

const patience = 1000; // ms after the answer, for a state that may never come: others seek too, frames get lost
const leadPatience = 150; // ms

interface Flight {
  target: number; // s
  lead: number; // s: still to be shown before the target; 0: nothing
  answered: number | undefined; // ms
}

/** What holds in the player just now. */
export interface Playing {
  now: number; // ms
  newest: number | undefined; // s, of the newest state
  speed: number; // simulated s per s; 0 while paused
  spacing: number; // s between two frames
}

/**
 * Takes a person to a moment of the recording. One seek is under way at a time; of the moments wished for meanwhile only the
 * latest counts. A moment holds until a state of it has come, so that nothing jumps back while answers are under way.
 */
export class Seeker {
  private flight: Flight | undefined;
  private next: { time: number; lead: number } | undefined;

  constructor(
    private readonly seek: (time: number) => Promise<Outcome>,
    private readonly now: () => number,
  ) {}

  /** The moment that is on its way, s; undefined: the server is where it was sent. */
  get wanted(): number | undefined {
    return this.next?.time ?? this.flight?.target;
  }

  /**
   * `lead`: show the moment that lies so far before this one first, s. While nothing moves speeds are told from two states,
   * and a moment alone has none.
   */
  want(time: number, lead = 0): void {
    this.next = { time, lead };
    if (!this.flight || this.flight.answered !== undefined) this.depart();
  }

  /** To be told often: lets go of the moment once it is there. */
  heed(playing: Playing): void {
    const { flight } = this;
    if (flight?.answered === undefined) return;
    const waited = playing.now - flight.answered;
    const place = flight.target - flight.lead;
    const near = 2 * playing.spacing + (playing.speed * 2 * waited) / 1000;
    // The state of a lead must not be mistaken for that of the moment itself, which may have been shown already.
    const after = flight.lead > 0 ? 1e-3 * playing.spacing : near;
    const ahead = playing.newest === undefined ? NaN : playing.newest - place;
    const there = -near <= ahead && ahead <= after;
    if (!there && waited < (flight.lead > 0 ? leadPatience : patience)) return;
    if (flight.lead > 0) {
      flight.lead = 0;
      void this.fly(flight);
    } else this.flight = undefined;
  }

  /** Another server, or none: what was wished for is void. */
  forget(): void {
    this.flight = undefined;
    this.next = undefined;
  }

  private depart(): void {
    if (!this.next) return;
    const { time, lead } = this.next;
    this.next = undefined;
    this.flight = { target: time, lead, answered: undefined };
    void this.fly(this.flight);
  }

  private async fly(flight: Flight): Promise<void> {
    flight.answered = undefined;
    const { case: how } = await this.seek(flight.target - flight.lead);
    if (this.flight !== flight) return;
    flight.answered = this.now();
    if (how !== "applied") this.flight = undefined;
    if (this.next) this.depart();
  }
}
