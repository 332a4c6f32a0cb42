import type { View } from "./messages";

const grace = 3000; // ms: who is back sooner need not begin with a keyframe

/** What the page asks to be sent: what the person wishes for, and no frames while the page is hidden. */
export class Watch {
  private hidden = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private wish: View,
    private readonly ask: (view: View) => void,
  ) {}

  get view(): View {
    return this.hidden ? { ...this.wish, rate: 0 } : this.wish;
  }

  want(wish: View): void {
    this.wish = wish;
    this.ask(this.view);
  }

  /** The page was hidden, or is shown again. */
  show(shown: boolean): void {
    clearTimeout(this.timer);
    if (shown === !this.hidden) return;
    if (shown) this.turn(false);
    else this.timer = setTimeout(() => this.turn(true), grace);
  }

  private turn(hidden: boolean): void {
    this.hidden = hidden;
    this.ask(this.view);
  }
}
