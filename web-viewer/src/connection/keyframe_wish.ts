const first = 2000; // ms
const longest = 16_000;
const calm = 60_000;

/**
 * Asks for a keyframe: at once, and again where none came or none could be decoded, but ever more rarely then, so that a
 * broken server and this page do not keep each other busy.
 */
export class KeyframeWish {
  private wait = first;
  private asked = -Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `ask` names the frame that could not be decoded. */
  constructor(
    private readonly ask: (sequence: bigint) => void,
    private readonly now: () => number = () => performance.now(),
  ) {}

  /** The frame could not be decoded. True where a keyframe was asked for just now; else that will be done. */
  want(sequence: bigint): boolean {
    if (this.timer !== undefined) return false;
    const left = this.asked + this.wait - this.now();
    if (left <= 0) {
      this.askNow(sequence);
      return true;
    }
    this.timer = setTimeout(() => this.askNow(sequence), left);
    return false;
  }

  /** A frame was decoded, or there is nobody to ask. */
  forget(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
  }

  private askNow(sequence: bigint): void {
    this.timer = undefined;
    const now = this.now();
    this.wait = now - this.asked > calm ? first : Math.min(longest, 2 * this.wait);
    this.asked = now;
    this.ask(sequence);
  }
}
