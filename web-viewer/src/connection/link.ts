import { create } from "@bufbuild/protobuf";
import { CommandSchema } from "../gen/spherule/v1/control_pb";
import type { Command, CommandResult } from "../gen/spherule/v1/control_pb";
import type { ControlWish, FromWorker, LinkState, ToWorker, View } from "./messages";

export type CommandKind = Command["kind"];

/** How a command ended; `lost` when it was not sent, or the connection went before its answer came. */
export type Outcome = CommandResult["outcome"] | { case: "lost"; value?: undefined };

/** The page's side of the connection: messages come to `listen`, commands go out and resolve with their outcome. */
export class Link {
  state: LinkState = "connecting";
  private readonly waiting = new Map<bigint, (outcome: Outcome) => void>();
  private lastId = 0n;

  constructor(
    private readonly worker: Worker,
    listen: (message: FromWorker) => void,
  ) {
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if (data.kind === "link") this.changed(data.state);
      if (data.kind === "result") this.answered(data.result);
      listen(data);
    };
  }

  /** `token`: for a server that asks for one; empty: there is none. */
  connect(url: string, view: View, token: string): void {
    this.post({ kind: "connect", url, view, token });
  }

  /** Connects anew with this token, or, where it is empty, without. */
  identify(token: string): void {
    this.post({ kind: "token", token });
  }

  retry(): void {
    this.post({ kind: "retry" });
  }

  watch(view: View): void {
    this.post({ kind: "view", view });
  }

  /** Pictures per second that the page draws now; 0: unknown. */
  draws(rate: number): void {
    this.post({ kind: "drawing", rate });
  }

  send(kind: CommandKind): Promise<Outcome> {
    if (this.state !== "open") return Promise.resolve({ case: "lost" });
    const id = ++this.lastId;
    this.post({ kind: "command", command: create(CommandSchema, { id, kind }) });
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  aboutControl(wish: ControlWish): void {
    this.post({ kind: "control", wish });
  }

  /** Gives the buffer of a state that is no longer needed back to the decoder. */
  recycle(positions: Float32Array): void {
    const buffer = positions.buffer as ArrayBuffer;
    if (buffer.byteLength > 0) this.post({ kind: "recycle", buffer }, [buffer]);
  }

  private post(message: ToWorker, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }

  private changed(state: LinkState): void {
    this.state = state;
    if (state === "open") return;
    for (const resolve of this.waiting.values()) resolve({ case: "lost" });
    this.waiting.clear();
  }

  private answered(result: CommandResult): void {
    this.waiting.get(result.id)?.(result.outcome);
    this.waiting.delete(result.id);
  }
}
