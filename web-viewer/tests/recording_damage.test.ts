import assert from "node:assert/strict";
import { test } from "node:test";
import { checksumOf, Kind, trailerBytes, viewOf } from "../src/archive/format";
import { fileOf, firstY, joined, partsOf, past, played, withLogs } from "./support/recordings";

const length = 60; // frames

/** Whole numbers below `end`, from a linear congruential sequence. */
function numbers(): (end: number) => number {
  let state = 1;
  return (end) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * end);
  };
}

/** Plays the file to its end. Each frame must be the one that was recorded at its time. True if nothing was wrong. */
function plays(file: Uint8Array): boolean {
  let player, content, frames, faults;
  try {
    ({ player, content, frames, faults } = played(file));
  } catch (error) {
    assert.ok(error instanceof Error && error.message.length > 0);
    assert.ok(!(error instanceof RangeError) && !(error instanceof TypeError), error.stack);
    return false;
  }
  for (let number = 1; number <= length; number++) player.seek(number / 10 + 1e-6);
  for (const frame of frames) {
    assert.equal(firstY(frame), (Math.round(10 * frame.simTime) - 1) / 2, `the frame at ${frame.simTime} s`);
  }
  return content.flaw === "" && content.damage.length === 0 && faults.length === 0;
}

test("a checksum is of the record, its place and its file; in version 1 of the record alone", () => {
  const record = Uint8Array.from({ length: 40 }, (_, k) => k);
  const changed = record.map((byte, k) => (k === 20 ? byte + 1 : byte));
  const sums = (version: number): bigint[] => [
    checksumOf(record, { version, id: 7 }, 16),
    checksumOf(record, { version, id: 8 }, 16),
    checksumOf(record, { version, id: 7 }, 24),
    checksumOf(record, { version, id: 7 }, 16 + 2 ** 32),
    checksumOf(changed, { version, id: 7 }, 16),
  ];
  assert.equal(new Set(sums(2)).size, 5);
  assert.equal(new Set(sums(1)).size, 2);
});

test("a recording that was cut, changed or put together anew is never taken for undamaged", () => {
  const own = withLogs(fileOf(past(length)));
  const parts = partsOf(own);
  const other = partsOf(withLogs(fileOf(past(length, 2))));
  assert.equal(other.records.length, parts.records.length);
  assert.ok(plays(own));
  const below = numbers();
  const spliced = (change: (records: Uint8Array[], at: number) => void) => (): Uint8Array => {
    const records = [...parts.records];
    change(records, below(records.length));
    return joined({ ...parts, records });
  };
  const record = (records: Uint8Array[], at: number): Uint8Array => records[at] as Uint8Array;
  const kinds: { [kind: string]: () => Uint8Array } = {
    cut: () => own.slice(0, below(own.byteLength)),
    bit: () => {
      const [at, bit] = [below(own.byteLength), below(8)];
      return own.map((byte, k) => (k === at ? byte ^ (1 << bit) : byte));
    },
    exchanged: spliced((records, at) => {
      const with_ = below(records.length);
      [records[at], records[with_]] = [record(records, with_), record(records, at)];
    }),
    repeated: spliced((records, at) => records.splice(below(records.length + 1), 0, record(records, at))),
    "left out": spliced((records, at) => records.splice(at, 1 + below(3))),
    "of another recording": spliced((records, at) => (records[at] = record(other.records, at))),
    "end of another recording": spliced((records, at) => records.splice(at, length, ...other.records.slice(at))),
  };
  for (const [kind, make] of Object.entries(kinds)) {
    for (let tried = 0; tried < 30;) {
      const file = make();
      if (Buffer.compare(file, own) === 0) continue;
      assert.ok(!plays(file), `${kind}, number ${tried}`);
      tried += 1;
    }
  }
});

const kindOf = (record: Uint8Array): number => viewOf(record).getUint32(4, true);

test("a damaged log in a file without an index ends the recording there", () => {
  const file = withLogs(fileOf(past(length))).subarray(0, -trailerBytes);
  const logs = partsOf(file).records.filter((record) => kindOf(record) === Kind.log);
  const record = logs[Math.floor(logs.length / 2)] as Uint8Array;
  const at = record.byteOffset - file.byteOffset;
  const time = viewOf(record).getFloat64(8, true);
  assert.equal(played(file).content.end, length / 10);
  for (const within of [5, 8, 20, record.byteLength - 1]) {
    const damaged = file.map((byte, k) => (k === at + within ? byte ^ 1 : byte));
    const { content, player, frames, faults } = played(damaged);
    assert.match(content.flaw, new RegExp(`^the record at byte ${at} is damaged`));
    assert.equal(content.end, time);
    player.seek(content.end);
    assert.deepEqual([frames.at(-1)?.simTime, faults], [time, []]);
  }
});

test("one changed bit that makes a log of a scene or an index is found", () => {
  const file = fileOf(past(length));
  for (const kind of [Kind.scene, Kind.index]) {
    const { records } = partsOf(file);
    const found = records.filter((record) => kindOf(record) === kind).at(-1) as Uint8Array;
    const damaged = file.slice();
    viewOf(damaged).setUint32(found.byteOffset - file.byteOffset + 4, Kind.log, true);
    assert.ok(!plays(damaged), `kind ${kind}`);
  }
});
