import assert from "node:assert/strict";
import { test } from "node:test";
import { allowed, entryError, entryText, parseEntry } from "../src/ui/entry";

test("numbers are read as people write them, and nothing else is a number", () => {
  const numbers: [string, number][] = [
    ["1", 1],
    [" -9.81 ", -9.81],
    ["−2.5", -2.5],
    ["1e-3", 0.001],
    ["1.0e−7", 1e-7],
    [".5", 0.5],
    ["5.", 5],
    ["16\u202f000\u202f000", 16e6],
    ["12 345", 12345],
  ];
  assert.deepEqual(
    numbers.map(([text]) => parseEntry(text)),
    numbers.map(([, value]) => value),
  );
  const wrong = ["", " ", "abc", "12abc", "1,5", "1.2.3", "1 2", "0x10", "Infinity", "NaN", "--1", "e5"];
  assert.deepEqual(
    wrong.map(parseEntry),
    wrong.map(() => NaN),
  );
});

test("a wrong entry is answered with the allowed numbers", () => {
  const rule = { unit: "m", least: 0.5, most: 20 };
  assert.deepEqual(
    [0.5, 20].map((value) => entryError(value, rule)),
    ["", ""],
  );
  for (const value of [0.49, 20.1, NaN, Infinity]) {
    assert.equal(entryError(value, rule), "Give a number from 0.5 to 20\u00a0m", String(value));
  }
  assert.equal(entryError(0, { unit: "N s", above: 0, most: 12 }), "Give a number above 0 and up to 12\u00a0N s");
  assert.equal(entryError(1.5, { unit: "", whole: true, least: 1 }), "Give a whole number of at least 1");
  const words = [{ unit: "m", above: 0 }, { unit: "m", most: 3 }, { unit: "m" }, { unit: "" }].map(allowed);
  assert.deepEqual(words, [
    "Give a number above 0\u00a0m",
    "Give a number of at most 3\u00a0m",
    "Give a number in m",
    "Give a number",
  ]);
});

test("the text of a value has no digits that say nothing, and is read back as the value", () => {
  const texts = [0, -9.81, 0.1 + 0.2, 1e-7, 123456.789, 2e15].map(entryText);
  assert.deepEqual(texts, ["0", "-9.81", "0.3", "1e-7", "123457", "2000000000000000"]);
  assert.deepEqual(texts.map(parseEntry), [0, -9.81, 0.3, 1e-7, 123457, 2e15]);
});
