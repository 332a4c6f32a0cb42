import type { Received, State } from "../connection/messages";
import { Timeline } from "./timeline";
import type { Pace } from "./timeline";

export interface Shown {
  from: State;
  to: State;
  mix: number;
  moving: boolean;
}

/** Simulated time of what is shown, s. */
export function timeOf({ from, to, mix }: Shown): number {
  return (1 - mix) * from.simTime + mix * to.simTime;
}

/** The newest states of one epoch; frames of another epoch are ignored. */
export class States {
  newest: State | undefined;
  epoch = -1;
  private readonly byKey = new Map<number, State>();
  private readonly timeline = new Timeline();
  private key = 0;

  /** `drop` is given each state that will not be shown any more. */
  constructor(private readonly drop: (state: State) => void) {}

  begin(epoch: number): void {
    if (epoch === this.epoch) return;
    this.epoch = epoch;
    this.newest = undefined;
    this.forget(this.timeline.clear());
  }

  /** Takes the frame, or returns false where it is not of this epoch. */
  push(frame: Received, pace?: Pace): boolean {
    if (frame.epoch !== this.epoch) {
      this.drop(frame);
      return false;
    }
    const key = ++this.key;
    this.byKey.set(key, frame);
    this.newest = frame;
    this.forget(this.timeline.push(key, frame.arrival, frame.simTime, pace));
    return true;
  }

  /** What to draw at `now`, on the clock of Received.arrival. */
  shown(now: number): Shown | undefined {
    const moment = this.timeline.sample(now);
    const from = moment && this.byKey.get(moment.from);
    const to = moment && this.byKey.get(moment.to);
    return moment && from && to && { from, to, mix: moment.mix, moving: moment.moving };
  }

  private forget(keys: number[]): void {
    for (const key of keys) {
      const state = this.byKey.get(key);
      this.byKey.delete(key);
      if (state) this.drop(state);
    }
  }
}
