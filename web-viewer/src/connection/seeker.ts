import type { Outcome } from "./link";

// How long to wait for the state of a seek after its answer (ms). It may never arrive: another client may seek too, and
// frames get lost.
const patience = 1000;
const leadPatience = 150;

interface Seek {
  target: number; // s
  lead: number; // s before the target, shown first; 0: none
  answered: number | undefined; // ms
}

/** The present state of the playback. */
export interface Playing {
  now: number; // ms
  newest: number | undefined; // s, time of the newest state
  speed: number; // simulated s per s; 0 while paused
  spacing: number; // s between two frames
}

/**
 * Seeks in a recording. One seek is in progress at a time; of the targets requested meanwhile only the latest counts. A
 * target holds until its state has arrived, so that the handle does not jump back while an answer is pending.
 */
export class Seeker {
  private current: Seek | undefined;
  private next: { time: number; lead: number } | undefined;

  constructor(
    private readonly send: (time: number) => Promise<Outcome>,
    private readonly now: () => number,
  ) {}

  /** Time of the latest target (s); undefined if no seek is in progress. */
  get target(): number | undefined {
    return this.next?.time ?? this.current?.target;
  }

  /**
   * Seeks to `time` (s). `lead` (s): first show the state that lies this long before it. Speeds are computed from two
   * states, and while playback is paused a seek brings only one.
   */
  seek(time: number, lead = 0): void {
    this.next = { time, lead };
    if (!this.current || this.current.answered !== undefined) this.start();
  }

  /** Ends the seek once its state has arrived. To be called often. */
  update(playing: Playing): void {
    const { current } = this;
    if (current?.answered === undefined) return;
    const waited = playing.now - current.answered;
    const time = current.target - current.lead;
    const near = 2 * playing.spacing + (playing.speed * 2 * waited) / 1000;
    // The state of the target may have been shown before the seek: it must not pass for the state of the lead.
    const after = current.lead > 0 ? 1e-3 * playing.spacing : near;
    const ahead = playing.newest === undefined ? NaN : playing.newest - time;
    const arrived = -near <= ahead && ahead <= after;
    if (!arrived && waited < (current.lead > 0 ? leadPatience : patience)) return;
    if (current.lead > 0) {
      current.lead = 0;
      void this.execute(current);
    } else this.current = undefined;
  }

  /** Drops all targets: the recording has changed, or there is none. */
  reset(): void {
    this.current = undefined;
    this.next = undefined;
  }

  private start(): void {
    if (!this.next) return;
    const { time, lead } = this.next;
    this.next = undefined;
    this.current = { target: time, lead, answered: undefined };
    void this.execute(this.current);
  }

  private async execute(seek: Seek): Promise<void> {
    seek.answered = undefined;
    const outcome = await this.send(seek.target - seek.lead);
    if (this.current !== seek) return;
    seek.answered = this.now();
    if (outcome.case !== "applied") this.current = undefined;
    if (this.next) this.start();
  }
}
