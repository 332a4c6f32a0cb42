/** Rounds up to 1, 2, 3 or 5 times a power of ten. */
export function niceAbove(value: number): number {
  if (!(value > 0)) return 0;
  const decade = 10 ** Math.floor(Math.log10(value));
  const step = [1, 2, 3, 5, 10].find((factor) => factor * decade >= value * (1 - 1e-9)) ?? 10;
  return step * decade;
}

/** Rounds down to 1, 2 or 5 times a power of ten. */
export function niceBelow(value: number): number {
  if (!(value > 0)) return 0;
  const decade = 10 ** Math.floor(Math.log10(value));
  return decade * ([5, 2, 1].find((factor) => factor * decade <= value * (1 + 1e-9)) ?? 1);
}

/**
 * The upper end of a colour range that follows the values shown. It rises at once, falls only after `patience` ms of
 * smaller values, so that the legend stays readable, and does not change while locked.
 */
export class AutoRange {
  locked = false;
  high: number;
  private lowerSince: number | undefined; // ms: since when all values were smaller
  private peak = 0; // largest value since then

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
      this.lowerSince = undefined;
      return;
    }
    if (this.lowerSince === undefined) {
      this.lowerSince = now;
      this.peak = wanted;
    }
    this.peak = Math.max(this.peak, wanted);
    if (now - this.lowerSince >= this.patience) {
      this.high = this.peak;
      this.lowerSince = undefined;
    }
  }

  /** Resets the range for another scene. */
  reset(): void {
    if (this.locked) return;
    this.high = this.least;
    this.lowerSince = undefined;
  }
}
