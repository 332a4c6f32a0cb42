import type { DrawOrder, Received, State } from "../connection/messages";
import { columnFormats } from "../columns";
import { PlayoutBuffer } from "./playout";
import type { TimeAdvance } from "./playout";
import type { Run } from "./population";
import { copyPositions } from "./units";

export type { DrawOrder, State };

/** The states that are drawn, interpolated by `mix` in 0..1. */
export interface Shown {
  from: State;
  to: State;
  mix: number;
  moving: boolean; // false: nothing changes until the next state arrives
}

/** The simulated time that is shown (s). */
export function timeOf({ from, to, mix }: Shown): number {
  return (1 - mix) * from.simTime + mix * to.simTime;
}

/** The time that is shown on the timeline (s). */
export function placeOf({ from, to, mix }: Shown): number {
  return (1 - mix) * (from.at ?? from.simTime) + mix * (to.at ?? to.simTime);
}

/** The newest states of one epoch. Frames of another epoch are ignored. */
export class States {
  newest: State | undefined;
  epoch = -1;
  private readonly byKey = new Map<number, State>();
  private readonly playout = new PlayoutBuffer();
  private key = 0;

  /** `drop` is given each state that will not be shown any more. */
  constructor(private readonly drop: (state: State) => void) {}

  begin(epoch: number): void {
    if (epoch === this.epoch) return;
    this.epoch = epoch;
    this.newest = undefined;
    this.remove(this.playout.clear());
  }

  /** Returns false if the frame is of another epoch. */
  push(frame: Received, advance?: TimeAdvance): boolean {
    if (frame.epoch !== this.epoch) {
      this.drop(frame);
      return false;
    }
    const key = ++this.key;
    this.byKey.set(key, frame);
    this.newest = frame;
    this.remove(this.playout.push(key, frame.arrival, frame.simTime, advance));
    return true;
  }

  /**
   * Copies the values at these places from a frame that is not pushed yet to all states before it. They hold other
   * spheres there, or none, and a sphere of the frame would move from the position of another.
   */
  carryBack(frame: State, places: readonly Run[]): void {
    for (const state of this.byKey.values()) {
      growBoxes(state, frame);
      for (const run of places) copyPositions(frame.columns.position, state.columns.position, run);
      for (const name of ["value", "turn"] as const) {
        const [column, earlier] = [frame.columns[name], state.columns[name]];
        if (!column || !earlier || column.quantity !== earlier.quantity) continue;
        const { components } = columnFormats[name];
        for (const { first, count } of places) {
          const begin = components * first;
          earlier.values.set(column.values.subarray(begin, begin + components * count), begin);
        }
      }
    }
  }

  /** Returns what to draw at `now`, on the clock of Received.arrival; undefined if there is no state. */
  shown(now: number): Shown | undefined {
    const sample = this.playout.sample(now);
    const from = sample && this.byKey.get(sample.from);
    const to = sample && this.byKey.get(sample.to);
    return sample && from && to && { from, to, mix: sample.mix, moving: sample.moving };
  }

  private remove(keys: number[]): void {
    for (const key of keys) {
      const state = this.byKey.get(key);
      this.byKey.delete(key);
      if (state) this.drop(state);
    }
  }
}

/** Makes the boxes of a state include the boxes of another one. */
function growBoxes({ boxes }: State, other: State): void {
  for (let k = 0; k < boxes.length; k++) {
    const value = other.boxes[k] ?? 0;
    boxes[k] = k % 6 < 3 ? Math.min(boxes[k] as number, value) : Math.max(boxes[k] as number, value);
  }
}
