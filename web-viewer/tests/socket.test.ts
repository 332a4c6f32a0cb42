import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Socket } from "../src/connection/socket";
import { timers } from "./support/timers";

/** What the browser gives a page, in the test's hands. */
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

  /** The server speaks. */
  say(): void {
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
  const said: string[] = [];
  const socket = new Socket("ws://here/ws", {
    opened: () => void said.push("opened"),
    received: () => {},
    changed: ({ state, reason, refused }) => void said.push([state, refused ? "refused" : "", reason].filter(Boolean).join(" ")),
    ask: () => {},
    silent: () => {},
  });
  return { socket, said, newest: () => FakeSocket.made.at(-1) as FakeSocket };
}

test("a server that asks for a token is left alone until there is one", () => {
  const { socket, said, newest } = connected();
  newest().onopen();
  newest().end(4401, "this server asks for a token");
  assert.deepEqual(said, ["connecting", "opened", "locked this server asks for a token"]);
  timers.tick(600_000);
  assert.equal(FakeSocket.made.length, 1);
  socket.renew();
  assert.equal(FakeSocket.made.length, 2);
  assert.equal(said.at(-1), "connecting");
  newest().end(4401, "this token is not known here");
  timers.tick(600_000);
  assert.equal(FakeSocket.made.length, 2);
});

test("a server that turns the page away is asked again, ever more rarely, and its reason told", () => {
  const { said, newest } = connected();
  for (const [code, reason] of [
    [1013, "the server is full"],
    [1008, "too many from your address"],
  ] as const) {
    const before = FakeSocket.made.length;
    newest().end(code, reason);
    assert.equal(said.at(-1), `waiting refused ${reason}`);
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

test("a restart is no refusal", () => {
  const { said, newest } = connected();
  newest().say();
  newest().end(1012, "the server is stopping");
  assert.equal(said.at(-1), "waiting the server is stopping");
  timers.tick(250);
  assert.equal(FakeSocket.made.length, 2);
  newest().end(1006, "");
});

test("to begin anew ends the connection that there is", () => {
  const { socket, newest } = connected();
  const first = newest();
  first.say();
  socket.renew();
  assert.equal(first.closed, true);
  assert.equal(FakeSocket.made.length, 2);
  first.end(1000, ""); // late, and of no interest
  timers.tick(5000);
  assert.equal(FakeSocket.made.length, 2);
  newest().end(4401, "");
});

test("a connection that works is not begun anew by asking for it", () => {
  const { socket, newest } = connected();
  newest().say();
  socket.retry();
  assert.equal(FakeSocket.made.length, 1);
  newest().end(1013, "full");
  socket.retry();
  assert.equal(FakeSocket.made.length, 2);
  newest().end(4401, "");
});
