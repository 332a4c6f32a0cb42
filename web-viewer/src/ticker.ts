const linger = 500; // ms of ticks after the last image or event
const restPeriod = 250; // ms between ticks at rest

/** Events after which the page may look different. */
const events = [
  ...["pointermove", "pointerdown", "pointerup", "pointercancel", "wheel", "click", "keydown", "keyup"],
  ...["input", "change", "focusin", "toggle", "dragover", "drop", "resize", "hashchange", "visibilitychange"],
];

/**
 * Calls a function before each image that the browser draws, as long as the page is active. It is active after an image
 * was drawn, or the user did something. At rest it calls the function four times a second, for
 * figures that depend on the time.
 */
export class Ticker {
  private lastActive = 0; // ms
  private requested = false; // the next image has a tick
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `tick`: given the time (ms); returns whether it has drawn an image. */
  constructor(private readonly tick: (now: number) => boolean) {}

  start(): void {
    for (const name of events) window.addEventListener(name, () => this.wake(), { capture: true, passive: true });
    this.wake();
  }

  /** Makes the page active. Events of the user do that, too. */
  wake(): void {
    this.lastActive = performance.now();
    this.request();
  }

  /** Asks for one tick before the next image. */
  request(): void {
    if (this.requested) return;
    this.requested = true;
    clearTimeout(this.timer);
    requestAnimationFrame((now) => this.run(now));
  }

  private run(now: number): void {
    this.requested = false;
    if (this.tick(now)) this.lastActive = now;
    if (now - this.lastActive < linger) this.request();
    else this.timer = setTimeout(() => this.request(), restPeriod);
  }
}
