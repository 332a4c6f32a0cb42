/** A sample of the motion: the states with the keys `from` and `to`, interpolated by `mix` in 0..1. */
export interface PlayoutSample {
  from: number;
  to: number;
  mix: number;
  moving: boolean; // false: the newest state is fully shown, and nothing changes until the next one arrives
}

interface Entry {
  key: number;
  simTime: number; // s
  begin: number; // ms: when the motion from the previous state begins
  show: number; // ms: when this state is fully shown
}

/** How simulated time advances without seeks and jumps. */
export interface TimeAdvance {
  speed: number; // simulated s per s, at most
  paused: boolean; // time advances only when a client requests a step
  spacing: number; // s between two frames of a recording; 0 if none is played
}

const unlimited: TimeAdvance = { speed: Infinity, paused: false, spacing: 0 };

export const capacity = 4; // states: the pair that is shown, and up to two that are due later

const maxReserve = 80; // ms; largest delay of a frame that the schedule absorbs
const delayDecay = 0.98; // factor per frame on the largest delay seen
const correction = 0.15; // share of a frame's delay by which the schedule moves
const tolerance = 2; // factor on the simulated time that can have passed without a jump
const stepDuration = 1000 / 30; // ms in which a single step is shown

/**
 * A playout buffer: decides when each state is shown, so that motion is even although frames arrive unevenly.
 *
 * A state is shown about one and a half frame intervals after its arrival, or later if frames arrive late or are
 * skipped. The distances between states follow simulated time. After a pause, motion starts again without stretching
 * over the pause. After a jump of simulated time, backwards or too far ahead, the new state is shown at once.
 */
export class PlayoutBuffer {
  private entries: Entry[] = [];
  private lastArrival = 0;
  private interval = 1000 / 30; // ms between arrivals, smoothed
  private rate = 0; // simulated s per ms, smoothed
  private maxDelay = 0; // ms, decaying

  /**
   * Adds a state that arrived at `arrival` (ms). Returns the keys that are no longer needed. A state of the same
   * simulated time as the newest replaces it. A state of an earlier time, or too far ahead for `advance`, clears the
   * buffer first.
   */
  push(key: number, arrival: number, simTime: number, advance = unlimited): number[] {
    const last = this.entries.at(-1);
    if (!last || simTime < last.simTime) return this.restart(key, arrival, simTime);
    if (simTime === last.simTime) {
      const replaced = last.key;
      last.key = key;
      this.lastArrival = arrival;
      return [replaced];
    }
    const gap = arrival - this.lastArrival;
    if (simTime - last.simTime > this.reach(gap, advance)) return this.restart(key, arrival, simTime);
    this.lastArrival = arrival;
    if (advance.paused && gap >= 4 * this.interval) {
      // A single step while paused: no other state need follow, so there is no reason to wait for one.
      const begin = Math.max(arrival, last.show);
      this.entries.push({ key, simTime, begin, show: begin + stepDuration });
      return this.trim();
    }
    this.learn(gap, simTime - last.simTime);
    const spacing = this.spacing(simTime - last.simTime);
    const ideal = arrival + this.delay();
    if (arrival > last.show) {
      // The buffer had run empty (a pause, or a very late frame): motion starts from the last state.
      this.entries.push({ key, simTime, begin: Math.max(arrival, ideal - spacing), show: ideal });
    } else {
      const even = last.show + spacing;
      this.entries.push({ key, simTime, begin: last.show, show: even + correction * (ideal - even) });
    }
    return this.trim();
  }

  /** Returns what to draw at `now` (ms); undefined if there is no state. */
  sample(now: number): PlayoutSample | undefined {
    const last = this.entries.at(-1);
    if (!last) return undefined;
    let at = this.entries.findIndex((entry) => entry.show > now);
    if (at < 0) at = this.entries.length - 1;
    if (at > 0 && now < (this.entries[at]?.begin ?? now)) at -= 1;
    const to = this.entries[at] ?? last;
    const from = this.entries[Math.max(0, at - 1)] ?? last;
    const mix = now < to.show ? Math.min(1, Math.max(0, (now - to.begin) / (to.show - to.begin))) : 1;
    return { from: from.key, to: to.key, mix, moving: to !== last || mix < 1 };
  }

  clear(): number[] {
    const keys = this.entries.map((entry) => entry.key);
    this.entries = [];
    return keys;
  }

  private restart(key: number, arrival: number, simTime: number): number[] {
    const dropped = this.clear();
    this.entries.push({ key, simTime, begin: arrival, show: arrival });
    this.lastArrival = arrival;
    return dropped;
  }

  private trim(): number[] {
    return this.entries.splice(0, Math.max(0, this.entries.length - capacity)).map((entry) => entry.key);
  }

  /** Simulated time (s) that can have passed in `gap` ms without a jump, with a margin for delayed frames. */
  private reach(gap: number, { speed, paused, spacing }: TimeAdvance): number {
    const margin = 4 * Math.min(this.interval, 1000 / 5); // ms; the slowest stream has 5 frames per second
    return Math.max(tolerance * spacing, (tolerance * speed * ((paused ? 0 : gap) + margin)) / 1000);
  }

  private learn(gap: number, simulated: number): void {
    const longest = 4 * this.interval;
    if (gap >= longest) {
      this.interval += 0.2 * (longest - this.interval); // a pause, or a stream that has become much slower
      return;
    }
    this.maxDelay = Math.max(gap - this.interval, delayDecay * this.maxDelay);
    this.interval += 0.2 * (Math.max(gap, 1) - this.interval);
    const rate = simulated / Math.max(gap, 1);
    this.rate = this.rate > 0 ? this.rate + 0.2 * (rate - this.rate) : rate;
  }

  /** Time between two states on the schedule (ms). */
  private spacing(simulated: number): number {
    const even = this.rate > 0 ? simulated / this.rate : this.interval;
    return Math.min(4 * this.interval, Math.max(0.25 * this.interval, even));
  }

  /** Time from arrival to display (ms). */
  private delay(): number {
    return this.interval + Math.min(Math.max(0.5 * this.interval, this.maxDelay), maxReserve);
  }
}
