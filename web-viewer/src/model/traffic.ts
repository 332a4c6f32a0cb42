const window = 2000; // ms

/** The cost of a frame. */
export interface FrameCost {
  arrival: number; // ms
  bytes: number;
  count: number; // spheres
  decodeMs: number;
}

export interface Rates {
  frames: number; // per second
  bytes: number; // per second
  bytesPerSphere: number; // per frame; NaN if there is none
  decodeMs: number; // mean per frame; NaN if there is none
}

/** Sums the cost of the frames of the last two seconds. */
export class Traffic {
  private readonly log: FrameCost[] = [];

  add({ arrival, bytes, count, decodeMs }: FrameCost): void {
    this.log.push({ arrival, bytes, count, decodeMs });
    this.removeOld(arrival);
  }

  rates(now: number): Rates {
    this.removeOld(now);
    const frames = this.log.length;
    const sum = (of: (cost: FrameCost) => number): number => this.log.reduce((total, cost) => total + of(cost), 0);
    const bytes = sum((cost) => cost.bytes);
    return {
      frames: (1000 * frames) / window,
      bytes: (1000 * bytes) / window,
      bytesPerSphere: bytes / sum((cost) => cost.count),
      decodeMs: sum((cost) => cost.decodeMs) / frames,
    };
  }

  private removeOld(now: number): void {
    while (this.log[0] && this.log[0].arrival < now - window) this.log.shift();
  }
}
