import assert from "node:assert/strict";
import { test } from "node:test";
import { Admission, withoutToken } from "../src/connection/admission";
import { TokenStore } from "../src/connection/token_store";

class Memory {
  readonly kept = new Map<string, string>();
  getItem = (key: string): string | null => this.kept.get(key) ?? null;
  setItem = (key: string, value: string): void => void this.kept.set(key, value);
  removeItem = (key: string): void => void this.kept.delete(key);
}

const here = "ws://here/ws";
const unknown = { state: "locked", reason: "this token is not known here" } as const;

/** An admission that logs its events. */
function admission(memory = new Memory()) {
  const events: string[] = [];
  const one = new Admission(new TokenStore(here, () => memory), {
    tokenRequired: (error) => void events.push(`required ${error}`.trim()),
    tokenSettled: () => void events.push("settled"),
    reconnect: (token) => void events.push(`reconnect ${token}`.trim()),
    tokenHeld: (held) => void events.push(held ? "held" : "none"),
  });
  const token = one.begin();
  return { one, events, memory, token };
}

test("a token is stored for one server, until it is removed", () => {
  const memory = new Memory();
  new TokenStore(here, () => memory).save("abc");
  assert.equal(new TokenStore(here, () => memory).token, "abc");
  assert.equal(new TokenStore("ws://here/other/ws", () => memory).token, "");
  new TokenStore(here, () => memory).save("");
  assert.equal(new TokenStore(here, () => memory).token, "");
  assert.equal(memory.kept.size, 0);
});

test("without storage, a token is kept until the page is reloaded", () => {
  const store = new TokenStore(here, () => {
    throw new Error("forbidden");
  });
  assert.equal(store.token, "");
  store.save("abc");
  assert.equal(store.token, "abc");
  store.save("");
  assert.equal(store.token, "");
});

test("a server that requires no token is sent none, and no dialog opens", () => {
  const { one, events, token } = admission();
  one.linkChanged({ state: "connecting" });
  one.linkChanged({ state: "open" });
  one.welcomed();
  assert.equal(token, "");
  assert.deepEqual(events, ["none", "settled"]);
});

test("without a token, the dialog opens without an error", () => {
  const { one, events } = admission();
  one.linkChanged({ state: "locked", reason: "this server asks for a token" });
  assert.deepEqual(events, ["none", "none", "required"]);
});

test("a submitted token is trimmed and remembered", () => {
  const { one, events, memory } = admission();
  assert.equal(one.submit(" \n abc\t"), true);
  assert.deepEqual(events, ["none", "held", "reconnect abc"]);
  assert.deepEqual([...memory.kept.values()], ["abc"]);
  assert.equal(admission(memory).token, "abc");
});

test("white space is no token", () => {
  const { one, events } = admission();
  assert.equal(one.submit(" \n"), false);
  assert.deepEqual(events, ["none"]);
});

test("a rejected token is forgotten, whether it was typed or remembered", () => {
  const typed = admission();
  typed.one.submit("abc");
  typed.one.linkChanged(unknown);
  assert.deepEqual(typed.events.slice(3), ["none", "required this token is not known here"]);
  assert.equal(typed.memory.kept.size, 0);

  const memory = new Memory();
  new TokenStore(here, () => memory).save("old");
  const remembered = admission(memory);
  remembered.one.linkChanged(unknown);
  assert.deepEqual(remembered.events, ["held", "none", "required this token is not known here"]);
  assert.equal(memory.kept.size, 0);
});

test("a connection that fails for another reason keeps the token", () => {
  const { one, events, memory } = admission();
  one.submit("abc");
  one.linkChanged({ state: "waiting", reason: "the server is full" });
  assert.equal(events.at(-1), "settled");
  assert.equal(memory.kept.size, 1);
});

test("forgetting the token reconnects without one", () => {
  const { one, events, memory } = admission();
  one.submit("abc");
  one.forget();
  assert.deepEqual(events.slice(3), ["none", "reconnect"]);
  assert.equal(memory.kept.size, 0);
});

test("only the token is removed from an address", () => {
  assert.equal(withoutToken("http://here/?token=abc"), "http://here/");
  const clean = withoutToken("http://here/a/?rate=10&Token=abc&theme=dark&token=#part");
  assert.equal(clean, "http://here/a/?rate=10&theme=dark#part");
  assert.equal(withoutToken("http://here/?rate=10"), undefined);
});
