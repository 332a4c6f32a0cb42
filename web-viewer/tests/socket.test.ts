import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Socket } from "../src/connection/socket";
import { timers } from "./support/timers";

/** A WebSocket that the test controls. */
class FakeSocket {
  static readonly OPEN = 1;
  static made: FakeSocket[] = [];
  readyState = 1;
  closed = false;
  onopen = (): void => {};
  onmessage = (_message: { data: ArrayBuffer }): void => {};
  onclose = (_event: { code: number; reason: string; wasClean: boolean }): void => {};

  constructor(readonly url: string) {
    FakeSocket.made.push(this);
  }

  close(): void {
    this.closed = true;
  }

  /** Delivers a message of the server. */
  receive(): void {
    this.onmessage({ data: new ArrayBuffer(1) });
  }

  end(code: number, reason: string): void {
    this.onclose({ code, reason, wasClean: true });
  }
}

const real = globalThis.WebSocket;
beforeEach(() => {
  timers.enable();
  FakeSocket.made = [];
  globalThis.WebSocket = FakeSocket as unknown as typeof WebSocket;
});
afterEach(() => {
  timers.reset();
  globalThis.WebSocket = real;
});

function connected() {
  const events: string[] = [];
  const socket = new Socket("ws://here/ws", {
    opened: () => void events.push("opened"),
    received: () => {},
    changed: ({ state, reason, refused }) => {
      events.push([state, refused ? "refused" : "", reason].filter(Boolean).join(" "));
    },
    probe: () => {},
    silent: () => {},
  });
  return { socket, events, newest: () => FakeSocket.made.at(-1) as FakeSocket };
}

test("after a server has required a token, nothing is tried until there is one", () => {
  const { socket, events, newest } = connected();
  newest().onopen();
  newest().end(4401, "this server asks for a token");
  assert.deepEqual(events, ["connecting", "opened", "locked this server asks for a token"]);
  timers.tick(600_000);
  assert.equal(FakeSocket.made.length, 1);
  socket.reconnect();
  assert.equal(FakeSocket.made.length, 2);
  assert.equal(events.at(-1), "connecting");
  newest().end(4401, "this token is not known here");
  timers.tick(600_000);
  assert.equal(FakeSocket.made.length, 2);
});

test("after a refusal the waits grow, and the reason is reported", () => {
  const { events, newest } = connected();
  for (const [code, reason] of [
    [1013, "the server is full"],
    [1008, "too many from your address"],
  ] as const) {
    const before = FakeSocket.made.length;
    newest().end(code, reason);
    assert.equal(events.at(-1), `waiting refused ${reason}`);
    timers.tick(8000);
    assert.equal(FakeSocket.made.length, before + 1);
  }
  for (let round = 0; round < 8; round++) {
    newest().end(1013, "the server is full");
    timers.tick(8000);
  }
  const before = FakeSocket.made.length;
  newest().end(1013, "the server is full");
  timers.tick(5000); // a quarter of 8 s is random
  assert.equal(FakeSocket.made.length, before);
});

test("a restart is not a refusal", () => {
  const { events, newest } = connected();
  newest().receive();
  newest().end(1012, "the server is stopping");
  assert.equal(events.at(-1), "waiting the server is stopping");
  timers.tick(250);
  assert.equal(FakeSocket.made.length, 2);
  newest().end(1006, "");
});

test("a reconnect closes the present connection", () => {
  const { socket, newest } = connected();
  const first = newest();
  first.receive();
  socket.reconnect();
  assert.equal(first.closed, true);
  assert.equal(FakeSocket.made.length, 2);
  first.end(1000, ""); // late: ignored
  timers.tick(5000);
  assert.equal(FakeSocket.made.length, 2);
  newest().end(4401, "");
});

test("a retry does not close a working connection", () => {
  const { socket, newest } = connected();
  newest().receive();
  socket.retry();
  assert.equal(FakeSocket.made.length, 1);
  newest().end(1013, "full");
  socket.retry();
  assert.equal(FakeSocket.made.length, 2);
  newest().end(4401, "");
});
