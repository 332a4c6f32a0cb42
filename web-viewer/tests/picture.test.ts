import assert from "node:assert/strict";
import { test } from "node:test";
import { largestSide, spansOf } from "../src/renderer/picture";

test("tiles cover a picture once, have at most 2048 pixels, and a margin where there is one", () => {
  for (const length of [16, 2047, 2048, 2049, 3840, 4000, largestSide]) {
    const spans = spansOf(length);
    let at = 0;
    for (const { begin, end, from, to } of spans) {
      assert.equal(begin, at);
      assert.ok(end > begin && to - from <= 2048 && from >= 0 && to <= length);
      assert.ok(begin - from >= Math.min(64, begin) && to - end >= Math.min(64, length - end));
      at = end;
    }
    assert.equal(at, length);
  }
  assert.equal(spansOf(1920).length, 1);
});
