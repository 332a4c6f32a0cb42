import type { MessageInitShape } from "@bufbuild/protobuf";
import type { AckSchema } from "../gen/spherule/v1/control_pb";
import type { Frame } from "../gen/spherule/v1/frame_pb";
import type { Frames } from "./frames";
import { KeyframeWish } from "./keyframe_wish";
import type { Received } from "./messages";

export interface StreamEvents {
  ack(ack: MessageInitShape<typeof AckSchema>): void;
  decoded(frame: Received): void;
  /** A frame is malformed; said once for each time that the chain is lost. */
  broken(reason: string): void;
  /** So many frames could not be decoded since the page was loaded. */
  lost(count: number): void;
}

/** Takes frames as they come: decodes them, says how that went, and asks for a keyframe where the chain is lost. */
export class Stream {
  drawRate = 0; // pictures per second; 0: unknown
  private count = 0; // of lost frames
  private told = false; // that the chain is lost
  private readonly wish: KeyframeWish;

  constructor(
    private readonly frames: Frames,
    private readonly events: StreamEvents,
  ) {
    this.wish = new KeyframeWish((sequence) => this.ack(sequence, 0, true));
  }

  /** Another connection. */
  reset(): void {
    this.frames.reset();
    this.told = false;
    this.wish.forget();
  }

  /** `arrival`: ms, as sharedNow() says; `bytes`: of the whole message. */
  take(frame: Frame, arrival: number, bytes: number): void {
    const begun = performance.now();
    let reason = "";
    try {
      const decoded = this.frames.decode(frame);
      if (decoded.kind === "state") {
        const decodeMs = performance.now() - begun;
        this.wish.forget();
        this.told = false;
        this.ack(frame.sequence, decodeMs, false);
        this.events.decoded(received(frame, decoded.positions, arrival, bytes, decodeMs));
        return;
      }
      // The server counts what is not acked as under way, so this one is too.
      if (decoded.kind === "foreign") return this.ack(frame.sequence, 0, false);
    } catch (error) {
      reason = error instanceof Error ? error.message : String(error);
    }
    this.lose(frame.sequence, reason);
  }

  private lose(sequence: bigint, reason: string): void {
    this.events.lost(++this.count);
    if (!this.wish.want(sequence)) this.ack(sequence, 0, false);
    if (this.told || !reason) return;
    this.told = true;
    this.events.broken(reason);
  }

  private ack(sequence: bigint, decodeMs: number, lost: boolean): void {
    this.events.ack({ sequence, decodeMs, drawRate: this.drawRate, lost });
  }
}

function received(frame: Frame, positions: Float32Array, arrival: number, bytes: number, decodeMs: number): Received {
  const { sequence, epoch, step, simTime, count, quantum, status, stampUs } = frame;
  return {
    sequence: Number(sequence),
    epoch,
    step: Number(step),
    simTime,
    count,
    positions,
    quantum,
    arrival,
    ready: Number(stampUs) / 1000,
    bytes,
    decodeMs,
    status,
  };
}
