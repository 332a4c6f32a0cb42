/** ms since 1970, on a clock that the page and its worker share and that nobody sets back. */
export function sharedNow(): number {
  return performance.timeOrigin + performance.now();
}

const window = 3000; // ms
const enough = 1000; // ms of drawing, for its rate to mean something

/** Times of the drawing loop, in ms. */
export class Clock {
  elapsed = 0; // since the tick before
  private now = 0;
  private lastDrawn = -Infinity;
  private tickBefore = -1;
  private readonly log: { at: number; took: number | undefined }[] = [];

  tick(now: number): void {
    this.elapsed = Math.min(100, now - this.now);
    this.tickBefore = this.now;
    this.now = now;
    while (this.log[0] && this.log[0].at < now - window) this.log.shift();
  }

  drew(): void {
    this.log.push({ at: this.now, took: this.sinceDrawn });
    this.lastDrawn = this.now;
  }

  /** Since the last picture, if that was drawn at the tick before; undefined after a rest. */
  get sinceDrawn(): number | undefined {
    return this.lastDrawn === this.tickBefore ? this.now - this.lastDrawn : undefined;
  }

  /** That were drawn in the last second, however much there was to draw. */
  get picturesPerSecond(): number {
    return this.log.filter(({ at }) => at >= this.now - 1000).length;
  }

  /** Pictures per second while there is something to draw; 0: unknown, as there was too little lately. */
  get drawRate(): number {
    let pictures = 0;
    let time = 0;
    for (const { took } of this.log) {
      if (took === undefined) continue;
      pictures += 1;
      time += took;
    }
    return time >= enough ? (1000 * pictures) / time : 0;
  }
}
