import { Quantity } from "../gen/spherule/v1/frame_pb";
import type { StreamRequest, ViewRequest } from "./messages";

const grace = 3000; // ms: a need that returns sooner keeps its stream, and needs no new keyframe

/** Requests the stream that the user has chosen, but no frames while the page is hidden, and speeds when needed. */
export class ViewSubscription {
  private hidden = false;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private needsSpeeds = false;
  private hasSpeeds = false;
  private speedTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private choice: ViewRequest,
    private readonly send: (view: StreamRequest) => void,
  ) {}

  get view(): StreamRequest {
    const rate = this.hidden ? 0 : this.choice.rate;
    return { ...this.choice, rate, quantity: this.hasSpeeds ? Quantity.SPEED : Quantity.QUANTITY_UNSPECIFIED };
  }

  /** Call whenever the page may begin or end to show speeds. */
  setSpeeds(needed: boolean): void {
    if (needed === this.needsSpeeds) return;
    this.needsSpeeds = needed;
    clearTimeout(this.speedTimer);
    if (needed) this.setHasSpeeds(true);
    else this.speedTimer = setTimeout(() => this.setHasSpeeds(false), grace);
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

  private setHasSpeeds(hasSpeeds: boolean): void {
    if (hasSpeeds === this.hasSpeeds) return;
    this.hasSpeeds = hasSpeeds;
    this.send(this.view);
  }

  private setHidden(hidden: boolean): void {
    this.hidden = hidden;
    this.send(this.view);
  }
}
