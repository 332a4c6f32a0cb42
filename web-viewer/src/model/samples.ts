import type { Diagnostics, Statistics } from "../gen/spherule/v1/diagnostics_pb";

/** Figures of the world, and of the way to it, at one moment. */
export interface Sample {
  statistics: Statistics;
  realTimeFactor: number; // NaN: unknown
  delay: number; // ms by which the newest frame was late (model/delay.ts); NaN: unknown
}

const capacity = 900; // the server sends about one a second

/** The newest samples of a run, oldest first. A new run begins without samples. */
export class Samples {
  readonly list: Sample[] = [];
  version = 0; // changes with the list

  add({ statistics }: Diagnostics, realTimeFactor = NaN, delay = NaN): void {
    const last = this.list.at(-1)?.statistics;
    if (!statistics || statistics.step === last?.step) return;
    if (last && statistics.step < last.step) this.list.length = 0;
    this.list.push({ statistics, realTimeFactor, delay });
    if (this.list.length > capacity) this.list.shift();
    this.version += 1;
  }

  clear(): void {
    this.list.length = 0;
    this.version += 1;
  }
}
