import { bufferOf } from "../columns";
import type { CommandResult } from "../gen/spherule/v1/control_pb";
import type { CommandMessage, ControlMessage, FromWorker, LinkState, State, StreamRequest, ToWorker } from "./messages";

export type CommandKind = NonNullable<CommandMessage["kind"]>;

/** How a command ended. `lost`: it was not sent, or the connection ended before its result arrived. */
export type Outcome = CommandResult["outcome"] | { case: "lost"; value?: undefined };

/** The page's end of the worker that holds the connection. Sends commands and resolves them with their outcome. */
export class Link {
  state: LinkState = "connecting";
  private readonly waiting = new Map<bigint, (outcome: Outcome) => void>();
  private lastId = 0n;

  /** `listen` is given every message of the worker. */
  constructor(
    private readonly worker: Worker,
    listen: (message: FromWorker) => void,
  ) {
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if (data.kind === "link") this.changed(data.state);
      if (data.kind === "result") this.resolve(data.result);
      listen(data);
    };
    worker.onerror = (event) => {
      throw new Error(`The connection's thread failed: ${event.message}`);
    };
  }

  /** `token`: empty if there is none. */
  connect(url: string, view: StreamRequest, token: string): void {
    this.post({ kind: "connect", url, view, token });
  }

  /** Reconnects with this token, or without one if it is empty. */
  reconnect(token: string): void {
    this.post({ kind: "token", token });
  }

  /** Connects now instead of at the end of the current wait. */
  retry(): void {
    this.post({ kind: "retry" });
  }

  /** Shows the present again, after the past. */
  showPresent(): void {
    this.post({ kind: "present" });
  }

  /** Has the last seconds written as a recording. */
  save(): void {
    this.post({ kind: "save" });
  }

  /** Plays a recording in place of the server's frames. */
  open(file: File): void {
    this.post({ kind: "open", file });
  }

  requestView(view: StreamRequest): void {
    this.post({ kind: "view", view });
  }

  /** Reports how many images per second the page draws; 0 if unknown. */
  reportDrawRate(rate: number): void {
    this.post({ kind: "drawing", rate });
  }

  /** `local`: the worker carries out the command, and needs no connection. */
  send(kind: CommandKind, local = false): Promise<Outcome> {
    if (this.state !== "open" && !local) return Promise.resolve({ case: "lost" });
    const id = ++this.lastId;
    this.post({ kind: "command", command: { id, kind } });
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  sendControl(message: ControlMessage): void {
    this.post({ kind: "control", message });
  }

  /** Returns the buffer of a state that is no longer needed to the decoder. */
  recycle(state: State): void {
    const buffer = bufferOf(state.columns);
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

  private resolve(result: CommandResult): void {
    this.waiting.get(result.id)?.(result.outcome);
    this.waiting.delete(result.id);
  }
}
