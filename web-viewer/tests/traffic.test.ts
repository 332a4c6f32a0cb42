import assert from "node:assert/strict";
import { test } from "node:test";
import { Traffic } from "../src/model/traffic";

test("traffic covers the last two seconds", () => {
  const traffic = new Traffic();
  for (let arrival = 0; arrival < 4000; arrival += 100) traffic.add({ arrival, bytes: 1000, count: 400, decodeMs: 3 });
  assert.deepEqual(traffic.rates(4000), { frames: 10, bytes: 10_000, bytesPerSphere: 2.5, decodeMs: 3 });
  assert.equal(traffic.rates(9000).frames, 0);
});
