const window = 2000; // ms

/** Frames and bytes per second over the last two seconds. */
export class Traffic {
  private readonly log: { at: number; bytes: number }[] = [];

  add(at: number, bytes: number): void {
    this.log.push({ at, bytes });
    this.forget(at);
  }

  rates(now: number): { frames: number; bytes: number } {
    this.forget(now);
    const bytes = this.log.reduce((sum, entry) => sum + entry.bytes, 0);
    return { frames: (1000 * this.log.length) / window, bytes: (1000 * bytes) / window };
  }

  private forget(now: number): void {
    while (this.log[0] && this.log[0].at < now - window) this.log.shift();
  }
}
