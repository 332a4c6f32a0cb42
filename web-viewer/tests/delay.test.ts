import assert from "node:assert/strict";
import { test } from "node:test";
import { DelayMeter } from "../src/model/delay";

test("the delay is relative to the fastest frame, and independent of clock offsets", () => {
  for (const ahead of [0, 1e6, -1e6]) {
    const delay = new DelayMeter();
    assert.equal(delay.newest, undefined);
    delay.add(2e9 + 50, 2e9 + ahead);
    assert.equal(delay.newest, 0);
    delay.add(2e9 + 150, 2e9 + 33 + ahead);
    assert.equal(delay.newest, 67);
    delay.add(2e9 + 110, 2e9 + 66 + ahead);
    assert.equal(delay.newest, 0);
  }
});

test("old frames do not count as the fastest", () => {
  const delay = new DelayMeter();
  for (let at = 1e9; at < 1e9 + 3_600_000; at += 10_000) delay.add(at * 1.0001, at); // clocks that drift apart
  assert.ok((delay.newest ?? NaN) <= 60, `${delay.newest}`);
});
