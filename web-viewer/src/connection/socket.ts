import { Backoff } from "./backoff";
import type { LinkChange } from "./messages";
import { refusals, subprotocol, tokenRequired } from "./protocol";
import { Watchdog } from "./watchdog";

export interface SocketEvents {
  opened(): void;
  received(data: ArrayBuffer): void;
  changed(change: Omit<LinkChange, "at">): void;
  /** Nothing has arrived for a while: ask the server for something that it answers at once. */
  probe(): void;
  /** Reports the duration of a silence (ms); undefined once a message has arrived. */
  silent(duration: number | undefined): void;
}

const openTimeout = 10_000; // ms for the server's first message

/** A WebSocket that reconnects by itself. The wait before an attempt grows only while no connection works. */
export class Socket {
  private socket: WebSocket | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined; // of the first message, or of the next attempt
  private readonly backoff = new Backoff();
  private readonly watchdog: Watchdog;

  constructor(
    private readonly url: string,
    private readonly events: SocketEvents,
  ) {
    this.watchdog = new Watchdog({
      probe: () => events.probe(),
      silent: (duration) => events.silent(duration),
      giveUp: () => this.retryLater({ reason: "the server stopped answering" }),
    });
    this.connect();
  }

  /** Returns false if there is no open connection. */
  send(data: Uint8Array<ArrayBuffer>): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(data);
    return true;
  }

  /** Closes the connection, until retry() or reconnect() is called. */
  close(): void {
    this.drop();
  }

  /** Connects now if there is no connection, or if the server is silent. */
  retry(): void {
    if (!this.socket || this.watchdog.silent) this.reconnect();
  }

  /** Closes the connection, if there is one, and connects now. */
  reconnect(): void {
    this.drop();
    this.backoff.reset();
    this.connect();
  }

  private connect(): void {
    this.events.changed({ state: "connecting" });
    const socket = new WebSocket(this.url, subprotocol);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.timer = setTimeout(() => this.retryLater({ reason: "no answer" }), openTimeout);
    socket.onopen = () => {
      if (this.socket === socket) this.events.opened();
    };
    socket.onmessage = (message: MessageEvent<unknown>) => {
      if (this.socket !== socket) return;
      if (this.timer !== undefined) this.firstMessage();
      this.watchdog.feed();
      if (message.data instanceof ArrayBuffer) this.events.received(message.data);
    };
    socket.onclose = (closed) => {
      if (this.socket !== socket) return;
      const reason = closed.reason || (closed.wasClean ? "closed by the server" : "no answer");
      if (closed.code === tokenRequired) this.lock(reason);
      else this.retryLater({ reason, refused: refusals.includes(closed.code) });
    };
  }

  private firstMessage(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.backoff.reset();
    this.watchdog.start();
  }

  /** Drops this connection, which may never close by itself, and plans the next attempt. */
  private retryLater(why: { reason: string; refused?: boolean }): void {
    this.drop();
    const retryIn = this.backoff.next();
    this.events.changed({ state: "waiting", retryIn, ...why });
    this.timer = setTimeout(() => this.connect(), retryIn);
  }

  /** Waits for another token: the server would reject the same hello again. */
  private lock(reason: string): void {
    this.drop();
    this.events.changed({ state: "locked", reason });
  }

  private drop(): void {
    const socket = this.socket;
    this.socket = undefined;
    socket?.close();
    this.watchdog.stop();
    clearTimeout(this.timer);
    this.timer = undefined;
  }
}
