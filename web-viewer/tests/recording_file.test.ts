import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { readRecording } from "../src/archive/recording_reader";
import { RecordingWriter } from "../src/archive/recording_writer";
import type { Segment } from "../src/connection/history";
import { PlacesSchema } from "../src/gen/spherule/v1/facts_pb";
import { fileOf, firstY, past, played, withLogs, xs } from "./support/recordings";

test("a written recording has the poses of obstacles, whatever frames are left out on the way", () => {
  const { player, frames } = played(fileOf(past()));
  for (const time of [5, 29.95, 0]) player.seek(time);
  player.step(1);
  const poses = frames.map(({ poses: [pose] }) => [pose?.obstacle, pose?.translation[0], pose?.rotation[2]]);
  assert.deepEqual(poses, [
    [1, 50, 0.6],
    [1, 299, 0.6],
    [1, 1, 0.6],
    [1, 2, 0.6],
  ]);
});

test("a written recording has the spheres and positions of the past", () => {
  const { content, history, player, frames, scenes } = played(fileOf(past()));
  assert.deepEqual([content.flaw, content.damage, content.end], ["", [], 30]);
  assert.deepEqual(content.settings?.gravity, [0, 0, -1]);
  assert.deepEqual([history.begin, history.end, history.frames], [0.1, 30, 300]);
  player.seek(0);
  assert.deepEqual([xs(frames.at(-1)), firstY(frames.at(-1))], [[0, 10, 15], 0]);
  player.seek(5);
  assert.deepEqual([xs(frames.at(-1)), firstY(frames.at(-1))], [[0, 10, 15, 5], 24.5]);
  player.seek(29.95);
  assert.deepEqual([xs(frames.at(-1)), firstY(frames.at(-1))], [[0, 15, 5], 149]);
  assert.deepEqual(
    frames.map(({ step, simTime }) => [step, simTime]),
    [
      [1, 0.1],
      [50, 5],
      [299, 29.9],
    ],
  );
  assert.deepEqual(
    scenes.map(({ count, places }) => [count, places.length]),
    [
      [3, 0],
      [4, 0],
      [3, 0],
    ],
  );
  const groups = scenes.map((facts) => facts.groups.map(({ name, first, count }) => `${name} ${first} ${count}`));
  assert.deepEqual(groups.map(String), ["one 0 1,two 1 2", "one 0 1,two 1 2,one 3 1", "one 0 1,two 1 1,one 2 1"]);
  assert.deepEqual(scenes[0]?.groups[0]?.material, 3);
  const radii = scenes.map((facts) => [...new Float32Array(facts.radii.slice().buffer)].map((one) => one.toFixed(2)));
  assert.deepEqual(radii.map(String), ["0.10,0.30,0.40", "0.10,0.30,0.40,0.25", "0.10,0.40,0.25"]);
});

test("playback can begin at any frame, and does not need the file's beginning", () => {
  const { player, frames, faults } = played(fileOf(past()));
  for (const time of [29, 0.1, 17.3, 17.4, 12.5, 3]) {
    player.seek(time + 1e-6);
    assert.equal(firstY(frames.at(-1)), (Math.round(10 * time) - 1) / 2, `at ${time} s`);
  }
  assert.deepEqual(faults, []);
});

test("time continues where the simulation's time is set back", () => {
  const first = past(20);
  const second = past(20).map((segment) => ({ ...segment, joins: false }));
  const { history, player, frames } = played(fileOf([...first, ...second]));
  assert.ok(Math.abs(history.end - (2 + 1.9)) < 1e-9, String(history.end));
  player.seek(history.end);
  assert.equal(frames.at(-1)?.step, 20);
});

test("recordings of the program are read in each version of the format", () => {
  const shown = [1, 2].map((version) => {
    const file = new Uint8Array(readFileSync(`../tests/golden/recording/version-${version}.sph`));
    assert.equal(file[8], version);
    const { content, history, player, frames, faults } = played(file);
    assert.deepEqual([content.flaw, content.damage, faults], ["", [], []]);
    assert.deepEqual([history.begin, history.end, history.frames], [0, 2.5, 11]);
    for (let time = 0; time < 2.6; time += 0.25) player.seek(time + 1e-6);
    assert.equal(frames.length, 11);
    return frames.map((frame) => [frame.simTime, xs(frame)]);
  });
  assert.deepEqual(shown[0], shown[1]);
});

test("a recording with a log plays the same frames as one without", () => {
  const file = fileOf(past());
  const shown = [file, withLogs(file)].map((recording) => {
    const { content, history, player, frames, scenes, faults } = played(recording);
    assert.deepEqual([content.flaw, content.damage, content.end], ["", [], 30]);
    for (const time of [12, 0, ...Array.from({ length: 300 }, (_, k) => (k + 1) / 10 + 1e-6)]) player.seek(time);
    assert.deepEqual(faults, []);
    const states = frames.map((frame) => [frame.step, frame.simTime, xs(frame), firstY(frame), frame.poses]);
    return { times: [history.begin, history.end, history.frames], states, scenes };
  });
  assert.ok((shown[0]?.states.length ?? 0) >= 300);
  assert.deepEqual(shown[1], shown[0]);
});

test("version 1 of the format has no logs", () => {
  const [first, second] = [1, 2].map((version) => readFileSync(`../tests/golden/recording/version-${version}.sph`));
  const { content } = played(withLogs(new Uint8Array(second as Buffer)));
  assert.deepEqual([content.flaw, content.damage, content.end], ["", [], 2.5]);
  const old = withLogs(new Uint8Array(first as Buffer));
  assert.match(played(old).content.damage[0] ?? "", /^the record at byte 16 is damaged: its head is invalid$/);
  assert.throws(() => readRecording(old.subarray(0, -1)), /no frames: the record at byte 16 is damaged/);
});

test("a foreign file is refused with the reason", () => {
  const file = fileOf(past(3));
  const changed = (at: number, byte: number): Uint8Array => file.map((value, k) => (k === at ? byte : value));
  assert.throws(() => readRecording(new TextEncoder().encode("PK, no recording")), /is no recording/);
  assert.throws(() => readRecording(new Uint8Array(0)), /is no recording/);
  assert.throws(() => readRecording(changed(8, 3)), /version 3 of the format; this page reads versions 1 and 2/);
  assert.throws(() => readRecording(file.subarray(0, 40)), /no frames: the record at byte 16 is cut off/);
});

test("a file that was cut off plays up to the cut, and says so", () => {
  const file = fileOf(past());
  const { content, player, frames, faults } = played(file.subarray(0, Math.floor(file.byteLength / 2)));
  assert.match(content.flaw, /^the record at byte \d+ is cut off$/);
  assert.ok(content.end > 5 && content.end < 25);
  player.seek(content.end);
  assert.equal(frames.at(-1)?.simTime, content.end);
  assert.deepEqual(faults, []);
});

test("a damaged frame is reported with its place, and playback goes on at the next keyframe", () => {
  const file = fileOf(past());
  const { content: whole } = played(file);
  const message = (whole.segments[6]?.entries[3] as { message: Uint8Array }).message;
  const damaged = file.slice();
  damaged[message.byteOffset - file.byteOffset + 9] = 0xff;
  const { content, player, frames, faults } = played(damaged);
  assert.equal(content.flaw, "");
  assert.match(content.damage.join(), /^the record at byte \d+ is damaged: its checksum differs$/);
  assert.equal(content.end, 30);
  for (let time = 0.1; time < 30; time += 0.1) player.seek(time);
  assert.deepEqual(faults, []);
  const steps = new Set(frames.map(({ step }) => step));
  assert.ok(steps.size > 270 && steps.size < 300, `${steps.size} frames are shown`);
});

test("a recording of no spheres has no frames", () => {
  const [segment] = past(5) as [Segment];
  const none = [create(PlacesSchema, { first: 0, count: 0 })];
  const writer = new RecordingWriter(undefined);
  writer.add({ ...segment, scene: { ...segment.scene, places: none } });
  assert.equal(writer.frames, 0);
});
