const memory = 300_000; // ms; limited because the clocks of server and page drift apart

/**
 * Measures how much longer the newest frame was in transit than the fastest frame of the last minutes. The absolute
 * transit time is unknown, because the clocks of server and page may differ by any amount.
 */
export class DelayMeter {
  newest: number | undefined; // ms
  private fastest = Infinity; // ms, in the present period
  private fastestBefore = Infinity; // ms, in the period before
  private periodStart = 0;

  reset(): void {
    this.newest = undefined;
    this.fastest = this.fastestBefore = Infinity;
  }

  /** `arrival` is on the page's clock, `ready` on the server's (ms); `ready` is 0 if unknown. */
  add(arrival: number, ready: number): void {
    if (!(ready > 0)) return;
    if (arrival - this.periodStart > memory) {
      this.fastestBefore = this.fastest;
      this.fastest = Infinity;
      this.periodStart = arrival;
    }
    const transit = arrival - ready;
    this.fastest = Math.min(this.fastest, transit);
    this.newest = transit - Math.min(this.fastest, this.fastestBefore);
  }
}
