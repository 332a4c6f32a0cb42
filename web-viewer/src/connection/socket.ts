import { Backoff } from "./backoff";
import type { LinkState } from "./messages";
import { Silence } from "./silence";

export interface SocketEvents {
  opened(): void;
  received(data: ArrayBuffer): void;
  state(state: LinkState, retryIn?: number, reason?: string): void;
  /** Nothing has come for a while: the server is to be asked for a word. */
  ask(): void;
  /** So long (ms), though it was asked; undefined: something has come again. */
  silent(since: number | undefined): void;
}

const subprotocol = "spherule.v1";
const patience = 10_000; // ms for the server's first word after opening, before trying again

/** A WebSocket that connects again by itself, sooner after a connection that worked than after one that did not. */
export class Socket {
  private socket: WebSocket | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly backoff = new Backoff();
  private readonly silence: Silence;

  constructor(
    private readonly url: string,
    private readonly events: SocketEvents,
  ) {
    this.silence = new Silence({
      ask: () => events.ask(),
      silent: (since) => events.silent(since),
      giveUp: () => this.leave("nothing came any more"),
    });
    this.connect();
  }

  /** Sends, or says that there is no connection. */
  send(data: Uint8Array<ArrayBuffer>): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(data);
    return true;
  }

  /** Tries now instead of at the end of the wait, or of the server's silence. */
  retry(): void {
    if (this.socket && !this.silence.lasts) return;
    if (this.socket) this.leave("");
    clearTimeout(this.timer);
    this.backoff.reset();
    this.connect();
  }

  private connect(): void {
    this.events.state("connecting");
    const socket = new WebSocket(this.url, subprotocol);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.timer = setTimeout(() => this.leave("no answer"), patience);
    socket.onopen = () => {
      if (this.socket === socket) this.events.opened();
    };
    socket.onmessage = (message: MessageEvent<unknown>) => {
      if (this.socket !== socket) return;
      if (this.timer !== undefined) this.begun();
      this.silence.heard();
      if (message.data instanceof ArrayBuffer) this.events.received(message.data);
    };
    socket.onclose = (closed) => {
      if (this.socket !== socket) return;
      this.leave(closed.reason || (closed.wasClean ? "closed by the server" : "no answer"));
    };
  }

  /** The server has said its first word. */
  private begun(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.backoff.reset();
    this.silence.begin();
  }

  /** Turns away from this connection, which may never close by itself, and tries another before long. */
  private leave(reason: string): void {
    const socket = this.socket;
    this.socket = undefined;
    socket?.close();
    this.silence.end();
    clearTimeout(this.timer);
    const wait = this.backoff.next();
    this.events.state("waiting", wait, reason);
    this.timer = setTimeout(() => this.connect(), wait);
  }
}
