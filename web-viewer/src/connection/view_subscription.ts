import type { ViewRequest } from "./messages";

const grace = 3000; // ms: a page that is shown again sooner keeps its stream, and needs no new keyframe

/** Requests the stream that the user has chosen, but no frames while the page is hidden. */
export class ViewSubscription {
  private hidden = false;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private choice: ViewRequest,
    private readonly send: (view: ViewRequest) => void,
  ) {}

  get view(): ViewRequest {
    return this.hidden ? { ...this.choice, rate: 0 } : this.choice;
  }

  request(choice: ViewRequest): void {
    this.choice = choice;
    this.send(this.view);
  }

  /** Call when the page is hidden or shown. */
  setVisible(visible: boolean): void {
    clearTimeout(this.timer);
    if (visible === !this.hidden) return;
    if (visible) this.setHidden(false);
    else this.timer = setTimeout(() => this.setHidden(true), grace);
  }

  private setHidden(hidden: boolean): void {
    this.hidden = hidden;
    this.send(this.view);
  }
}
