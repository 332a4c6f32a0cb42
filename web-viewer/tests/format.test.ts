import assert from "node:assert/strict";
import { test } from "node:test";
import { bytes, bytesPerSecond, clockTime, count, figure, length, recordingTime } from "../src/format";

test("figures are formatted with few digits", () => {
  assert.equal(count(1234567), "1\u202f234\u202f567");
  const figures = ["0", "1", "0.5", "12.3", "1234", "−0.0123", "99999"];
  assert.deepEqual([0, 1, 0.5, 12.34, 1234, -0.0123, 99999].map(figure), figures);
  assert.deepEqual([0.05, 1.5, 0.0023].map(length), ["5 cm", "1.5 m", "2.3 mm"]);
  assert.deepEqual([53_000, 1_234_000].map(bytesPerSecond), ["53 kB/s", "1.23 MB/s"]);
});

test("sizes and times of recordings are formatted", () => {
  assert.deepEqual([0, 18_000, 3_400_000, 2.5e9].map(bytes), ["0 kB", "18 kB", "3.4 MB", "2.50 GB"]);
  assert.deepEqual([0, 12.9, 75, 3671].map(clockTime), ["0:00", "0:12", "1:15", "1:01:11"]);
  const times = [[3.2, 10], [65, 200], [0.0123, 0.05], [0, 0]] as const;
  const texts = times.map(([time, duration]) => recordingTime(time, duration));
  assert.deepEqual(texts, ["3.20 s", "1:05", "0.0123 s", "0.00 s"]);
});
