const memory = 300_000; // ms, so that clocks which drift apart do not look like a growing delay

/**
 * How much longer the newest frame was on its way than the quickest one of the last minutes. The clocks of server and page
 * may differ by anything, so how long that one took is not known.
 */
export class Lateness {
  newest: number | undefined; // ms
  private quickest = Infinity;
  private quickestBefore = Infinity; // in the stretch of time before this one
  private begun = 0;

  reset(): void {
    this.newest = undefined;
    this.quickest = this.quickestBefore = Infinity;
  }

  /** Both in ms, each by its own clock; `ready` 0: not known. */
  add(arrival: number, ready: number): void {
    if (!(ready > 0)) return;
    if (arrival - this.begun > memory) {
      this.quickestBefore = this.quickest;
      this.quickest = Infinity;
      this.begun = arrival;
    }
    const way = arrival - ready;
    this.quickest = Math.min(this.quickest, way);
    this.newest = way - Math.min(this.quickest, this.quickestBefore);
  }
}
