import assert from "node:assert/strict";
import { test } from "node:test";
import * as format from "../src/format";

const gap = "\u202f";

/** Checks texts of values; gaps are written as blanks in `expected`. */
function check(name: string, texts: (value: number) => string, table: [value: number, expected: string][]): void {
  test(name, () => {
    const seen = table.map(([value]) => [value, texts(value).replaceAll(gap, " ")]);
    assert.deepEqual(seen, table);
  });
}

const none: [number, string][] = [
  [NaN, "–"],
  [Infinity, "–"],
  [-Infinity, "–"],
];

check("counts", format.count, [
  ...none,
  [0, "0"],
  [-0, "0"],
  [-1234, "−1 234"],
  [0.4, "0"],
  [999, "999"],
  [16_000_000, "16 000 000"],
  [999_999_999_999, "999 999 999 999"],
  [1e15, "1e15"],
  [1.8446744073709552e19, "1.84e19"],
]);

test("counts of 64 bits", () => {
  const texts = [0n, 12_345n, 999_999_999_999_999n, 18_446_744_073_709_551_615n].map(format.count);
  assert.deepEqual(texts, ["0", `12${gap}345`, ["999", "999", "999", "999", "999"].join(gap), "1.84e19"]);
});

check("figures", format.figure, [
  ...none,
  [0, "0"],
  [-0, "0"],
  [1, "1"],
  [0.5, "0.5"],
  [12.34, "12.3"],
  [-0.0123, "−0.0123"],
  [1234, "1234"],
  [99_999, "99999"],
  [123_456, "123 456"],
  [-2.5e6, "−2 500 000"],
  [1e-7, "1.0e−7"],
  [-1e-7, "−1.0e−7"],
  [1e15, "1e15"],
  [-1.234e15, "−1.23e15"],
]);

check("figures with prefixes", (value) => format.withPrefix(value, "J"), [
  ...none,
  [0, "0 J"],
  [1, "1 J"],
  [-0.0123, "−12.3 mJ"],
  [1e-7, "100 nJ"],
  [1e-15, "1.0e−15 J"],
  [999.9, "1 kJ"],
  [1234, "1.23 kJ"],
  [5.6e14, "560 TJ"],
  [1e15, "1e15 J"],
]);

check("lengths", format.length, [
  ...none,
  [0, "0 m"],
  [0.05, "5 cm"],
  [1.5, "1.5 m"],
  [-0.0023, "−2.3 mm"],
  [1e-7, "100 nm"],
  [2.5e-5, "25 µm"],
  [25_000, "25 km"],
  [1e15, "1e15 m"],
]);

check("durations", format.seconds, [
  ...none,
  [0, "0.00 s"],
  [1e-7, "100 ns"],
  [0.0042, "4.2 ms"],
  [3.2, "3.20 s"],
  [-3.2, "−3.20 s"],
  [99.99, "99.99 s"],
  [125.9, "2 min 5 s"],
  [4812.33, "1 h 20 min"],
  [86_399, "23 h 59 min"],
  [3 * 86_400 + 4 * 3600, "3 d 4 h"],
  [15 * 86_400, "2 weeks 1 d"],
  [1e15, "1e15 s"],
]);

check("bytes", format.bytes, [
  ...none,
  [0, "0 kB"],
  [18_000, "18 kB"],
  [3_400_000, "3.4 MB"],
  [2.5e9, "2.50 GB"],
  [4e12, "4 TB"],
]);

check("bytes per second", format.bytesPerSecond, [
  ...none,
  [0, "0 kB/s"],
  [53_000, "53 kB/s"],
  [1_234_000, "1.23 MB/s"],
  [12_340_000, "12.3 MB/s"],
  [2e9, "2 GB/s"],
]);

check("bits per second", format.bitsPerSecond, [...none, [0, "0 Mb/s"], [125_000, "1 Mb/s"]]);

check("clock times", format.clockTime, [
  ...none,
  [0, "0:00"],
  [12.9, "0:12"],
  [75, "1:15"],
  [3671, "1:01:11"],
  [15 * 86_400 + 3671, "15 d 1:01:11"],
]);

test("vectors have the same digits, unless that would hide them or take much room", () => {
  const rows: [number[], string][] = [
    [[0, 0, 0], "0.00  0.00  0.00"],
    [[1.234, -2, 0.001], "1.23  −2.00  0.00"],
    [[1, 0, -0.001], "1.00  0.00  0.00"],
    [[1e-7, 0, -2e-7], "1.0e−7  0  −2.0e−7"],
    [[1e15, 1, 0], "1e15  1  0"],
    [[NaN, 1, 2], "–  1  2"],
  ];
  assert.deepEqual(
    rows.map(([values]) => format.vector(values)),
    rows.map(([, text]) => text),
  );
});

test("times in a recording", () => {
  const times = [
    [3.2, 10],
    [65, 200],
    [0.0123, 0.05],
    [0, 0],
    [NaN, 10],
  ] as const;
  const texts = times.map(([time, duration]) => format.recordingTime(time, duration));
  assert.deepEqual(texts, ["3.20 s", "1:05", "0.0123 s", "0.00 s", "–"]);
});

test("sentences", () => {
  assert.deepEqual(["the end", "Done.  ", "ab. c"].map(format.sentence), ["The end.", "Done.", "Ab. c."]);
});
