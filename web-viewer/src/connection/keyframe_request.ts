const firstWait = 2000; // ms between two requests
const longestWait = 16_000;
const calm = 60_000; // ms without a request, after which the wait starts at `firstWait` again

/**
 * Requests a keyframe at once, and again with growing waits while frames still cannot be decoded. The waits keep a
 * broken server and this page from flooding each other.
 */
export class KeyframeRequester {
  private wait = firstWait;
  private lastRequest = -Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `send` is given the sequence number of the frame that could not be decoded. */
  constructor(
    private readonly send: (sequence: bigint) => void,
    private readonly now: () => number = () => performance.now(),
  ) {}

  /** Call when a frame cannot be decoded. Returns true if a request was sent now, false if it is sent later. */
  request(sequence: bigint): boolean {
    if (this.timer !== undefined) return false;
    const left = this.lastRequest + this.wait - this.now();
    if (left <= 0) {
      this.sendNow(sequence);
      return true;
    }
    this.timer = setTimeout(() => this.sendNow(sequence), left);
    return false;
  }

  /** Cancels a planned request: a frame was decoded, or the connection ended. */
  cancel(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  private sendNow(sequence: bigint): void {
    this.timer = undefined;
    const now = this.now();
    this.wait = now - this.lastRequest > calm ? firstWait : Math.min(longestWait, 2 * this.wait);
    this.lastRequest = now;
    this.send(sequence);
  }
}
