import type { MessageInitShape } from "@bufbuild/protobuf";
import type { AckSchema } from "../gen/spherule/v1/control_pb";
import type { Frame } from "../gen/spherule/v1/frame_pb";
import type { Content, Frames } from "./frames";
import { KeyframeRequester } from "./keyframe_request";
import type { Received } from "./messages";

export interface StreamEvents {
  ack(ack: MessageInitShape<typeof AckSchema>): void;
  /** `message`: that had the frame. */
  decoded(state: Received, frame: Frame, message: Uint8Array, keyframe: boolean): void;
  /** A frame is malformed. Reported once each time that the chain is lost. */
  malformed(reason: string): void;
  /** Reports how many frames could not be decoded since the page was loaded. */
  lost(count: number): void;
}

/** Receives frames: decodes them, acknowledges them, and requests a keyframe when the chain is lost. */
export class Stream {
  drawRate = 0; // images per second; 0: unknown
  shown = true; // false: states are not shown, and have no content
  private lostFrames = 0;
  private reported = false; // the loss of this chain
  private readonly keyframe: KeyframeRequester;

  constructor(
    private readonly frames: Frames,
    private readonly events: StreamEvents,
  ) {
    this.keyframe = new KeyframeRequester((sequence) => this.ack(sequence, 0, true));
  }

  /** Call when a new connection has been made. */
  reset(): void {
    this.frames.reset();
    this.reported = false;
    this.keyframe.cancel();
  }

  /** `message`: that had the frame; `arrival`: ms, as sharedNow() counts. */
  receive(frame: Frame, message: Uint8Array, arrival: number): void {
    const start = performance.now();
    let reason = "";
    try {
      const decoded = this.frames.decode(frame, this.shown);
      if (decoded.kind === "state") {
        const decodeMs = performance.now() - start;
        this.keyframe.cancel();
        this.reported = false;
        this.ack(frame.sequence, decodeMs, false);
        const cost = { arrival, bytes: message.byteLength, decodeMs };
        this.events.decoded(received(frame, decoded.content, cost), frame, message, decoded.keyframe);
        return;
      }
      // The server counts every frame without an ack as in flight, so ignored frames are acknowledged too.
      if (decoded.kind === "foreign") return this.ack(frame.sequence, 0, false);
    } catch (error) {
      reason = error instanceof Error ? error.message : String(error);
    }
    this.lose(frame.sequence, reason);
  }

  private lose(sequence: bigint, reason: string): void {
    this.events.lost(++this.lostFrames);
    if (!this.keyframe.request(sequence)) this.ack(sequence, 0, false);
    if (this.reported || !reason) return;
    this.reported = true;
    this.events.malformed(reason);
  }

  private ack(sequence: bigint, decodeMs: number, lost: boolean): void {
    this.events.ack({ sequence, decodeMs, drawRate: this.drawRate, lost });
  }
}

/** `cost`: of the frame. */
export function received(
  frame: Frame,
  content: Content,
  cost: Pick<Received, "arrival" | "bytes" | "decodeMs">,
): Received {
  const { sequence, epoch, step, simTime, count, population, poses, status, stampUs } = frame;
  return {
    sequence: Number(sequence),
    epoch,
    step: Number(step),
    simTime,
    count,
    population,
    poses,
    ...content,
    ready: Number(stampUs) / 1000,
    status,
    ...cost,
  };
}
