import { Backoff } from "./backoff";
import type { LinkChange } from "./messages";
import { Silence } from "./silence";

export interface SocketEvents {
  opened(): void;
  received(data: ArrayBuffer): void;
  changed(change: Omit<LinkChange, "at">): void;
  /** Nothing has come for a while: the server is to be asked for a word. */
  ask(): void;
  /** So long (ms), though it was asked; undefined: something has come again. */
  silent(since: number | undefined): void;
}

const subprotocol = "spherule.v1";
const wantsToken = 4401; // close codes
const turnedAway = [1008, 1013];
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
      giveUp: () => this.leave({ reason: "nothing came any more" }),
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
    if (!this.socket || this.silence.lasts) this.renew();
  }

  /** Begins anew, whatever there is. */
  renew(): void {
    this.drop();
    this.backoff.reset();
    this.connect();
  }

  private connect(): void {
    this.events.changed({ state: "connecting" });
    const socket = new WebSocket(this.url, subprotocol);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.timer = setTimeout(() => this.leave({ reason: "no answer" }), patience);
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
      const reason = closed.reason || (closed.wasClean ? "closed by the server" : "no answer");
      if (closed.code === wantsToken) this.lock(reason);
      else this.leave({ reason, refused: turnedAway.includes(closed.code) });
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
  private leave(why: { reason: string; refused?: boolean }): void {
    this.drop();
    const retryIn = this.backoff.next();
    this.events.changed({ state: "waiting", retryIn, ...why });
    this.timer = setTimeout(() => this.connect(), retryIn);
  }

  /** The same hello would be refused again: waits for another one. */
  private lock(reason: string): void {
    this.drop();
    this.events.changed({ state: "locked", reason });
  }

  private drop(): void {
    const socket = this.socket;
    this.socket = undefined;
    socket?.close();
    this.silence.end();
    clearTimeout(this.timer);
    this.timer = undefined;
  }
}
