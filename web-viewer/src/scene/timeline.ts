/** What to draw: the states with these keys, mixed by `mix` in 0..1. */
export interface Moment {
  from: number;
  to: number;
  mix: number;
  moving: boolean; // false: the newest state is fully shown and nothing changes until the next one comes
}

interface Entry {
  key: number;
  simTime: number; // s
  begin: number; // ms: when the motion from the state before begins
  show: number; // ms: when this state is fully shown
}

/** How simulated time goes on by itself. */
export interface Pace {
  speed: number; // at most, simulated s per s
  paused: boolean; // goes on only where somebody asks for it
  spacing: number; // s between two frames of a recording; 0: there is none
}

const free: Pace = { speed: Infinity, paused: false, spacing: 0 };

export const capacity = 4; // states kept: the pair that is shown and up to two that wait

const reserve = 80; // ms at most that a frame may be late without being noticed
const forgiving = 0.98; // per frame: how soon an earlier lateness is forgotten
const steadiness = 0.15; // share of a frame's lateness that moves the schedule
const tolerance = 2; // of how far time can have come by itself
const glide = 1000 / 30; // ms for a state that came alone

/**
 * Decides when each state is shown, so that motion is even although frames come unevenly: about one and a half frame
 * intervals after it came (more where frames come late or are skipped), at distances that follow simulated time. After
 * a pause the motion begins anew instead of stretching over it. Where time has jumped, back or further than it goes by
 * itself, the new state is shown at once: nothing has moved from the one to the other.
 */
export class Timeline {
  private entries: Entry[] = [];
  private lastArrival = 0;
  private interval = 1000 / 30; // ms between arrivals, smoothed
  private rate = 0; // simulated s per ms, smoothed
  private lateness = 0; // ms: the worst of late

  /**
   * A state came at `arrival` (ms). Returns the keys that are no longer needed. A state of the same simulated time as
   * the newest takes its place; one of an earlier time starts over, and so does one that is too far ahead for `pace`.
   */
  push(key: number, arrival: number, simTime: number, pace = free): number[] {
    const last = this.entries.at(-1);
    if (!last || simTime < last.simTime) return this.restart(key, arrival, simTime);
    if (simTime === last.simTime) {
      const replaced = last.key;
      last.key = key;
      this.lastArrival = arrival;
      return [replaced];
    }
    const gap = arrival - this.lastArrival;
    if (simTime - last.simTime > this.reach(gap, pace)) return this.restart(key, arrival, simTime);
    this.lastArrival = arrival;
    if (pace.paused && gap >= 4 * this.interval) {
      // Somebody asked for this state, and none may follow: it says nothing of the stream, and nothing is gained by waiting.
      const begin = Math.max(arrival, last.show);
      this.entries.push({ key, simTime, begin, show: begin + glide });
      return this.surplus();
    }
    this.learn(gap, simTime - last.simTime);
    const spacing = this.spacing(simTime - last.simTime);
    const ideal = arrival + this.delay();
    if (arrival > last.show) {
      // Nothing was left to show (a pause, or a very late frame): move on from the last state, which was held.
      this.entries.push({ key, simTime, begin: Math.max(arrival, ideal - spacing), show: ideal });
    } else {
      const even = last.show + spacing;
      this.entries.push({ key, simTime, begin: last.show, show: even + steadiness * (ideal - even) });
    }
    return this.surplus();
  }

  /** The moment to draw at `now` (ms); undefined while there is no state. */
  sample(now: number): Moment | undefined {
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

  private surplus(): number[] {
    return this.entries.splice(0, Math.max(0, this.entries.length - capacity)).map((entry) => entry.key);
  }

  /** Simulated s that can have passed by themselves in `gap` ms, with room for frames that were held up on their way. */
  private reach(gap: number, { speed, paused, spacing }: Pace): number {
    const held = 4 * Math.min(this.interval, 1000 / 5); // no stream is slower
    return Math.max(tolerance * spacing, tolerance * speed * ((paused ? 0 : gap) + held) / 1000);
  }

  private learn(gap: number, simulated: number): void {
    const longest = 4 * this.interval;
    if (gap >= longest) {
      this.interval += 0.2 * (longest - this.interval); // a pause says little, but a much slower stream looks the same
      return;
    }
    this.lateness = Math.max(gap - this.interval, forgiving * this.lateness);
    this.interval += 0.2 * (Math.max(gap, 1) - this.interval);
    const rate = simulated / Math.max(gap, 1);
    this.rate = this.rate > 0 ? this.rate + 0.2 * (rate - this.rate) : rate;
  }

  private spacing(simulated: number): number {
    return Math.min(4 * this.interval, Math.max(0.25 * this.interval, this.rate > 0 ? simulated / this.rate : this.interval));
  }

  private delay(): number {
    return this.interval + Math.min(Math.max(0.5 * this.interval, this.lateness), reserve);
  }
}
