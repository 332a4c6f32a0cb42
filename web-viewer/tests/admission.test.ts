import assert from "node:assert/strict";
import { test } from "node:test";
import { Admission } from "../src/connection/admission";
import { withoutToken } from "../src/connection/address";
import { TokenStore } from "../src/connection/token_store";

class Memory {
  readonly kept = new Map<string, string>();
  getItem = (key: string): string | null => this.kept.get(key) ?? null;
  setItem = (key: string, value: string): void => void this.kept.set(key, value);
  removeItem = (key: string): void => void this.kept.delete(key);
}

const here = "ws://here/ws";
const unknown = { state: "locked", reason: "this token is not known here" } as const;

/** An admission with all that it says. */
function admission(memory = new Memory()) {
  const said: string[] = [];
  const one = new Admission(new TokenStore(here, () => memory), {
    ask: (wrong) => void said.push(`ask ${wrong}`.trim()),
    done: () => void said.push("done"),
    identify: (token) => void said.push(`identify ${token}`.trim()),
    held: (held) => void said.push(held ? "held" : "none"),
  });
  const token = one.begin();
  return { one, said, memory, token };
}

test("a token is kept for its server alone, until it is forgotten", () => {
  const memory = new Memory();
  new TokenStore(here, () => memory).keep("abc");
  assert.equal(new TokenStore(here, () => memory).token, "abc");
  assert.equal(new TokenStore("ws://here/other/ws", () => memory).token, "");
  new TokenStore(here, () => memory).keep("");
  assert.equal(new TokenStore(here, () => memory).token, "");
  assert.equal(memory.kept.size, 0);
});

test("a browser that keeps nothing still knows the token until the page is loaded again", () => {
  const store = new TokenStore(here, () => {
    throw new Error("forbidden");
  });
  assert.equal(store.token, "");
  store.keep("abc");
  assert.equal(store.token, "abc");
  store.keep("");
  assert.equal(store.token, "");
});

test("a server that asks for nothing is told nothing and shows nothing", () => {
  const { one, said, token } = admission();
  one.changed({ state: "connecting" });
  one.changed({ state: "open" });
  one.welcomed();
  assert.equal(token, "");
  assert.deepEqual(said, ["none", "done"]);
});

test("who has no token is asked for one, without a reproach", () => {
  const { one, said } = admission();
  one.changed({ state: "locked", reason: "this server asks for a token" });
  assert.deepEqual(said, ["none", "none", "ask"]);
});

test("a token is handed over without the space around it, and remembered", () => {
  const { one, said, memory } = admission();
  assert.equal(one.submit(" \n abc\t"), true);
  assert.deepEqual(said, ["none", "held", "identify abc"]);
  assert.deepEqual([...memory.kept.values()], ["abc"]);
  assert.equal(admission(memory).token, "abc");
});

test("space alone is no token", () => {
  const { one, said } = admission();
  assert.equal(one.submit(" \n"), false);
  assert.deepEqual(said, ["none"]);
});

test("a token that is refused is forgotten, whether it was typed or remembered", () => {
  const typed = admission();
  typed.one.submit("abc");
  typed.one.changed(unknown);
  assert.deepEqual(typed.said.slice(3), ["none", "ask this token is not known here"]);
  assert.equal(typed.memory.kept.size, 0);

  const memory = new Memory();
  new TokenStore(here, () => memory).keep("old");
  const remembered = admission(memory);
  remembered.one.changed(unknown);
  assert.deepEqual(remembered.said, ["held", "none", "ask this token is not known here"]);
  assert.equal(memory.kept.size, 0);
});

test("a connection that fails for another reason keeps the token", () => {
  const { one, said, memory } = admission();
  one.submit("abc");
  one.changed({ state: "waiting", reason: "the server is full" });
  assert.equal(said.at(-1), "done");
  assert.equal(memory.kept.size, 1);
});

test("to forget the token is to connect without", () => {
  const { one, said, memory } = admission();
  one.submit("abc");
  one.forget();
  assert.deepEqual(said.slice(3), ["none", "identify"]);
  assert.equal(memory.kept.size, 0);
});

test("a token is taken out of an address, and nothing else is", () => {
  assert.equal(withoutToken("http://here/?token=abc"), "http://here/");
  assert.equal(withoutToken("http://here/a/?rate=10&Token=abc&theme=dark&token=#part"), "http://here/a/?rate=10&theme=dark#part");
  assert.equal(withoutToken("http://here/?rate=10"), undefined);
});
