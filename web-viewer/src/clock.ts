/** ms since 1970, on a clock that the page and its worker share and that nobody sets back. */
export function sharedNow(): number {
  return performance.timeOrigin + performance.now();
}

/** Times of the drawing loop, in ms. */
export class Clock {
  elapsed = 0; // since the tick before
  private now = 0;
  private lastDrawn = -Infinity;
  private tickBefore = -1;
  private readonly log: number[] = [];

  tick(now: number): void {
    this.elapsed = Math.min(100, now - this.now);
    this.tickBefore = this.now;
    this.now = now;
    while (this.log[0] !== undefined && this.log[0] < now - 1000) this.log.shift();
  }

  drew(): void {
    this.lastDrawn = this.now;
    this.log.push(this.now);
  }

  /** Since the last picture, if that was drawn at the tick before; undefined after a rest. */
  get sinceDrawn(): number | undefined {
    return this.lastDrawn === this.tickBefore ? this.now - this.lastDrawn : undefined;
  }

  get picturesPerSecond(): number {
    return this.log.length;
  }
}
