/** The next of 1, 2, 3, 5 times a power of ten that is at least `value`. */
export function niceAbove(value: number): number {
  if (!(value > 0)) return 0;
  const decade = 10 ** Math.floor(Math.log10(value));
  const step = [1, 2, 3, 5, 10].find((factor) => factor * decade >= value * (1 - 1e-9)) ?? 10;
  return step * decade;
}

/**
 * The upper end of a colour range that follows what is shown: it widens at once, narrows only after a calm time (so
 * that a legend can be read), and stays where it is while locked.
 */
export class AutoRange {
  locked = false;
  high: number;
  private calmSince: number | undefined;
  private peak = 0;

  constructor(
    private readonly least: number,
    private readonly patience = 2500, // ms
  ) {
    this.high = least;
  }

  update(value: number, now: number): void {
    if (this.locked) return;
    const wanted = Math.max(this.least, niceAbove(value));
    if (wanted >= this.high) {
      this.high = wanted;
      this.calmSince = undefined;
      return;
    }
    if (this.calmSince === undefined) {
      this.calmSince = now;
      this.peak = wanted;
    }
    this.peak = Math.max(this.peak, wanted);
    if (now - this.calmSince >= this.patience) {
      this.high = this.peak;
      this.calmSince = undefined;
    }
  }

  /** Starts over for another scene. */
  reset(): void {
    if (this.locked) return;
    this.high = this.least;
    this.calmSince = undefined;
  }
}
