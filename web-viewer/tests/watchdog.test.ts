import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Watchdog } from "../src/connection/watchdog";
import { timers } from "./support/timers";

let now = 0;
let events: string[] = [];
let watchdog: Watchdog;

/** Lets time pass while the thread runs (ms). */
function pass(ms: number): void {
  for (let left = ms; left > 0; left -= 100) {
    now += 100;
    timers.tick(100);
  }
}

const count = (word: string): number => events.filter((one) => one === word).length;

beforeEach(() => {
  timers.enable();
  now = 0;
  events = [];
  watchdog = new Watchdog(
    {
      probe: () => void events.push("probe"),
      silent: (duration) => void events.push(duration === undefined ? "heard" : "silent"),
      giveUp: () => {
        events.push("gives up");
        watchdog.stop();
      },
    },
    () => now,
  );
});
afterEach(() => {
  watchdog.stop();
  timers.reset();
});

test("a server that sends messages is not probed", () => {
  watchdog.start();
  for (let k = 0; k < 100; k++) {
    pass(1500);
    watchdog.feed();
  }
  assert.deepEqual(events, []);
});

test("a quiet server is probed, and nothing is reported if it answers", () => {
  watchdog.start();
  for (let k = 0; k < 10; k++) {
    pass(2600);
    watchdog.feed();
  }
  assert.deepEqual(events, Array(10).fill("probe"));
});

test("silence is reported within seconds, and then the connection is given up", () => {
  watchdog.start();
  pass(4600);
  assert.deepEqual(events, ["probe", "probe", "silent"]);
  assert.ok(watchdog.silent);
  pass(8000);
  assert.equal(events.at(-1), "gives up");
  pass(60_000);
  assert.equal(count("gives up"), 1);
});

test("the end of a silence is reported", () => {
  watchdog.start();
  pass(8000);
  watchdog.feed();
  assert.equal(events.at(-1), "heard");
  assert.ok(!watchdog.silent);
});

test("the timeout doubles after each connection given up, and is reset after a calm time", () => {
  for (const longer of [12_000, 24_000, 48_000, 96_000, 96_000]) {
    events = [];
    watchdog.start();
    pass(longer - 1000);
    assert.equal(count("gives up"), 0);
    pass(2000);
    assert.equal(count("gives up"), 1, `after ${longer} ms`);
  }
  watchdog.start();
  for (let k = 0; k < 61; k++) {
    pass(1000);
    watchdog.feed();
  }
  events = [];
  pass(13_000);
  assert.equal(count("gives up"), 1);
});

test("time in which the page slept does not count", () => {
  watchdog.start();
  for (let k = 0; k < 3; k++) {
    now += 3_600_000;
    timers.tick(500);
  }
  assert.equal(count("silent") + count("gives up"), 0);
});
