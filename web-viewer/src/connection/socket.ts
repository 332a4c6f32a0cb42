import { Backoff } from "./backoff";
import type { LinkState } from "./messages";

export interface SocketEvents {
  opened(): void;
  received(data: ArrayBuffer): void;
  state(state: LinkState, retryIn?: number, reason?: string): void;
}

const subprotocol = "spherule.v1";
const patience = 10_000; // ms for the server's first word after opening, before trying again

/** A WebSocket that connects again by itself, sooner after a connection that worked than after one that did not. */
export class Socket {
  private socket: WebSocket | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly backoff = new Backoff();

  constructor(
    private readonly url: string,
    private readonly events: SocketEvents,
  ) {
    this.connect();
  }

  /** Sends, or says that there is no connection. */
  send(data: Uint8Array<ArrayBuffer>): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(data);
    return true;
  }

  /** Tries now instead of at the end of the wait. */
  retry(): void {
    if (this.socket) return;
    clearTimeout(this.timer);
    this.backoff.reset();
    this.connect();
  }

  private connect(): void {
    this.events.state("connecting");
    const socket = new WebSocket(this.url, subprotocol);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    const silence = setTimeout(() => socket.close(), patience);
    socket.onopen = () => {
      this.events.opened();
    };
    socket.onmessage = (message: MessageEvent<unknown>) => {
      clearTimeout(silence);
      this.backoff.reset();
      if (message.data instanceof ArrayBuffer) this.events.received(message.data);
    };
    socket.onclose = (closed) => {
      clearTimeout(silence);
      if (this.socket !== socket) return;
      this.socket = undefined;
      const wait = this.backoff.next();
      this.events.state("waiting", wait, closed.reason || (closed.wasClean ? "closed by the server" : "no answer"));
      this.timer = setTimeout(() => this.connect(), wait);
    };
  }
}
