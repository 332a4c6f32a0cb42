/** Milliseconds since 1970 on a monotonic clock that the page and its worker share. */
export function sharedNow(): number {
  return performance.timeOrigin + performance.now();
}

const window = 3000; // ms
const enough = 1000; // ms of continuous drawing from which a rate can be computed

/** Times of the draw loop (ms). */
export class DrawClock {
  elapsed = 0; // since the previous tick
  private now = 0;
  private lastDrawn = -Infinity;
  private previousTick = -1;
  private readonly log: { at: number; took: number | undefined }[] = []; // images of the last `window` ms

  tick(now: number): void {
    this.elapsed = Math.min(100, now - this.now);
    this.previousTick = this.now;
    this.now = now;
    while (this.log[0] && this.log[0].at < now - window) this.log.shift();
  }

  /** Call when an image has been drawn at this tick. */
  drew(): void {
    this.log.push({ at: this.now, took: this.sinceDrawn });
    this.lastDrawn = this.now;
  }

  /** Time since the last image, if that was drawn at the previous tick; undefined if a tick was skipped. */
  get sinceDrawn(): number | undefined {
    return this.lastDrawn === this.previousTick ? this.now - this.lastDrawn : undefined;
  }

  /** Number of images drawn in the last second. Low while nothing changes. */
  get imagesPerSecond(): number {
    const since = this.now - 1000;
    let first = this.log.length;
    while (first > 0 && (this.log[first - 1] as { at: number }).at >= since) first -= 1;
    return this.log.length - first;
  }

  /** Images per second during continuous drawing; 0 if there was too little of it lately. */
  get drawRate(): number {
    let images = 0;
    let time = 0;
    for (const { took } of this.log) {
      if (took === undefined) continue;
      images += 1;
      time += took;
    }
    return time >= enough ? (1000 * images) / time : 0;
  }
}
