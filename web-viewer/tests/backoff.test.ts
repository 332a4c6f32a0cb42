import assert from "node:assert/strict";
import { test } from "node:test";
import { Backoff } from "../src/connection/backoff";

test("waits double up to their limit, and start over after a success", () => {
  const backoff = new Backoff(100, 1000, () => 0);
  assert.deepEqual(
    [1, 2, 3, 4, 5, 6].map(() => backoff.next()),
    [100, 200, 400, 800, 1000, 1000],
  );
  backoff.reset();
  assert.equal(backoff.next(), 100);
});

test("waits are shortened at random by at most a quarter", () => {
  assert.equal(new Backoff(100, 1000, () => 1).next(), 75);
});
