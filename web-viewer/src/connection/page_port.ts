import { bufferOf } from "../columns";
import type { Frames } from "./frames";
import type { FromWorker, Received } from "./messages";

/** The worker's way to the page. */
export class PagePort {
  private told: Uint32Array | undefined; // the places of the order that the page knows

  constructor(readonly post: (message: FromWorker, transfer?: Transferable[]) => void) {}

  /** Shows a state that `frames` has decoded. The order of drawing comes before the first state that has it. */
  show(frame: Received, frames: Frames): void {
    const order = frames.drawOrder;
    if (order.places !== this.told) {
      this.told = order.places;
      this.post({ kind: "order", order });
    }
    this.post({ kind: "frame", frame }, [bufferOf(frame.columns)]);
  }
}
