const window = 2000; // ms

/** What a frame cost. */
export interface Load {
  arrival: number; // ms
  bytes: number;
  count: number; // spheres
  decodeMs: number;
}

export interface Rates {
  frames: number; // per second
  bytes: number; // per second
  bytesPerSphere: number; // of a frame; NaN without frames
  decodeMs: number; // of a frame, mean; NaN without frames
}

/** What frames cost over the last two seconds. */
export class Traffic {
  private readonly log: Load[] = [];

  add({ arrival, bytes, count, decodeMs }: Load): void {
    this.log.push({ arrival, bytes, count, decodeMs });
    this.forget(arrival);
  }

  rates(now: number): Rates {
    this.forget(now);
    const frames = this.log.length;
    const sum = (of: (load: Load) => number): number => this.log.reduce((total, load) => total + of(load), 0);
    const bytes = sum((load) => load.bytes);
    return {
      frames: (1000 * frames) / window,
      bytes: (1000 * bytes) / window,
      bytesPerSphere: bytes / sum((load) => load.count),
      decodeMs: sum((load) => load.decodeMs) / frames,
    };
  }

  private forget(now: number): void {
    while (this.log[0] && this.log[0].arrival < now - window) this.log.shift();
  }
}
