import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Silence } from "../src/connection/silence";
import { timers } from "./support/timers";

let now = 0;
let said: string[] = [];
let silence: Silence;

/** So many ms go by, in which this thread is awake. */
function pass(ms: number): void {
  for (let left = ms; left > 0; left -= 100) {
    now += 100;
    timers.tick(100);
  }
}

const count = (word: string): number => said.filter((one) => one === word).length;

beforeEach(() => {
  timers.enable();
  now = 0;
  said = [];
  silence = new Silence(
    {
      ask: () => void said.push("ask"),
      silent: (since) => void said.push(since === undefined ? "heard" : "silent"),
      giveUp: () => {
        said.push("gives up");
        silence.end();
      },
    },
    () => now,
  );
});
afterEach(() => {
  silence.end();
  timers.reset();
});

test("who is heard is left in peace", () => {
  silence.begin();
  for (let k = 0; k < 100; k++) {
    pass(1500);
    silence.heard();
  }
  assert.deepEqual(said, []);
});

test("who is quiet is asked, and when he answers nothing is said of it", () => {
  silence.begin();
  for (let k = 0; k < 10; k++) {
    pass(2600);
    silence.heard();
  }
  assert.deepEqual(said, Array(10).fill("ask"));
});

test("who does not answer is told of within seconds, then given up", () => {
  silence.begin();
  pass(4600);
  assert.deepEqual(said, ["ask", "ask", "silent"]);
  assert.ok(silence.lasts);
  pass(8000);
  assert.equal(said.at(-1), "gives up");
  pass(60_000);
  assert.equal(count("gives up"), 1);
});

test("who is heard again after all is told of too", () => {
  silence.begin();
  pass(8000);
  silence.heard();
  assert.equal(said.at(-1), "heard");
  assert.ok(!silence.lasts);
});

test("a line on which messages take long is waited for ever longer, until it has been quick for a while", () => {
  for (const longer of [12_000, 24_000, 48_000, 96_000, 96_000]) {
    said = [];
    silence.begin();
    pass(longer - 1000);
    assert.equal(count("gives up"), 0);
    pass(2000);
    assert.equal(count("gives up"), 1, `after ${longer} ms`);
  }
  silence.begin();
  for (let k = 0; k < 61; k++) {
    pass(1000);
    silence.heard();
  }
  said = [];
  pass(13_000);
  assert.equal(count("gives up"), 1);
});

test("time in which the page slept is no silence", () => {
  silence.begin();
  for (let k = 0; k < 3; k++) {
    now += 3_600_000;
    timers.tick(500);
  }
  assert.equal(count("silent") + count("gives up"), 0);
});
