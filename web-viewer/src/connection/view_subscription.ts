import { Quantity } from "../gen/spherule/v1/frame_pb";
import type { StreamRequest, ViewRequest } from "./messages";

const grace = 3000; // ms: a need that returns sooner keeps its stream, and needs no new keyframe

/**
 * Requests the stream that the user has chosen, but no frames while the page is hidden, and a quantity and angular
 * velocities when needed.
 */
export class ViewSubscription {
  private hidden = false;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private needed = Quantity.QUANTITY_UNSPECIFIED;
  private requested = Quantity.QUANTITY_UNSPECIFIED;
  private spins = false;
  private quantityTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private choice: ViewRequest,
    private readonly send: (view: StreamRequest) => void,
  ) {}

  get view(): StreamRequest {
    const rate = this.hidden ? 0 : this.choice.rate;
    return { ...this.choice, rate, quantity: this.requested, spins: this.spins };
  }

  /** Call whenever the page may show another quantity, or none (unspecified). */
  setQuantity(needed: Quantity): void {
    if (needed === this.needed) return;
    this.needed = needed;
    clearTimeout(this.quantityTimer);
    if (needed !== Quantity.QUANTITY_UNSPECIFIED) this.requestQuantity(needed);
    else this.quantityTimer = setTimeout(() => this.requestQuantity(needed), grace);
  }

  /** Call whenever the page may need angular velocities, or none. */
  setSpins(needed: boolean): void {
    if (needed === this.spins) return;
    this.spins = needed;
    this.send(this.view);
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

  private requestQuantity(quantity: Quantity): void {
    if (quantity === this.requested) return;
    this.requested = quantity;
    this.send(this.view);
  }

  private setHidden(hidden: boolean): void {
    this.hidden = hidden;
    this.send(this.view);
  }
}
