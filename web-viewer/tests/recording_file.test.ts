import { create, toBinary } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { readRecording } from "../src/archive/recording_reader";
import { RecordingWriter } from "../src/archive/recording_writer";
import { BufferPool } from "../src/connection/buffer_pool";
import { Frames } from "../src/connection/frames";
import { History } from "../src/connection/history";
import type { Segment } from "../src/connection/history";
import { LookBack } from "../src/connection/look_back";
import type { Received } from "../src/connection/messages";
import { Player } from "../src/connection/player";
import { ServerMessageSchema, SettingsSchema } from "../src/gen/spherule/v1/control_pb";
import { PlacesSchema, PopulationSchema, SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import type { SceneFacts } from "../src/gen/spherule/v1/facts_pb";
import { coordinate } from "../src/model/units";
import { frameOf, keyframe, moved, orderOf } from "./support/chain";

/** A past with four places. The second is free before the 50th frame, and the third from the 100th on. */
function past(frames = 300): readonly Segment[] {
  const lookBack = new LookBack();
  const decoder = new Frames(new BufferPool());
  const radii = new Uint8Array(Float32Array.of(0.1, 0.2, 0.3, 0.4).buffer);
  const places = [
    create(PlacesSchema, { first: 0, count: 1, id: 0n, group: 0 }),
    create(PlacesSchema, { first: 2, count: 2, id: 2n, group: 1 }),
  ];
  const groups = [{ name: "one", material: 3 }, { name: "two" }];
  const bounds = { boundsMin: [-99, -99, -99], boundsMax: [99, 99, 99] };
  const facts = create(SceneFactsSchema, { epoch: 3, name: "test", count: 4, radii, places, groups, ...bounds });
  decoder.setScene(3, 4);
  decoder.setOrder(orderOf([3, 1, 0, 2]));
  lookBack.sceneReceived(facts);
  lookBack.settings = create(SettingsSchema, { gravity: [0, 0, -1] });
  for (let number = 1; number <= frames; number++) {
    if (number === 50) {
      const radius = new Uint8Array(Float32Array.of(0.25).buffer);
      const added = [create(PlacesSchema, { first: 1, count: 1, id: 7n, group: 0, radii: radius })];
      lookBack.populationReceived(create(PopulationSchema, { epoch: 3, number: 1, added }));
    }
    if (number === 100) {
      const removed = [create(PlacesSchema, { first: 2, count: 1 })];
      lookBack.populationReceived(create(PopulationSchema, { epoch: 3, number: 2, removed }));
    }
    const population = number < 50 ? 0 : number < 100 ? 1 : 2;
    const first = (): Uint8Array =>
      keyframe(1, [
        [30, 0, 0],
        [10, 0, 0],
        [0, 0, 0],
        [20, 0, 0],
      ]);
    const spb = number === 1 ? first() : moved(number, 4, [0, 1, 0]);
    const times = { step: BigInt(number), simTime: number / 10, stampUs: BigInt(number * 100_000) };
    const poses = [{ obstacle: 1, translation: [number, 0, 0], rotation: [0, 0, 0.6, 0.8] }];
    const frame = frameOf(spb, { count: 4, population, quantum: 0.5, poses, ...times });
    const message = create(ServerMessageSchema, { kind: { case: "frame", value: frame } });
    const decoded = decoder.decode(frame);
    assert.ok(decoded.kind === "state");
    lookBack.frameDecoded(frame, toBinary(ServerMessageSchema, message), decoded.keyframe, decoder);
  }
  return lookBack.history.all;
}

function fileOf(segments: readonly Segment[]): Uint8Array {
  const writer = new RecordingWriter(undefined);
  for (const segment of segments) writer.add(segment);
  writer.finish();
  return new Uint8Array(Buffer.concat(writer.parts));
}

/** What a player shows of the file. */
function played(bytes: Uint8Array) {
  const content = readRecording(bytes);
  const history = new History();
  for (const { entries, begin, ...start } of content.segments) {
    history.open(start, begin);
    for (const entry of entries) history.add(entry);
  }
  const frames: Received[] = [];
  const scenes: SceneFacts[] = [];
  const faults: string[] = [];
  const player = new Player(history, true, new BufferPool(), {
    scene: (facts) => void scenes.push(facts),
    population: () => assert.fail("recordings have no changes of the population"),
    frame: (frame) => void frames.push(frame),
    damaged: (reason) => void faults.push(reason),
    ended: () => undefined,
  });
  player.paused = true;
  return { content, history, player, frames, scenes, faults };
}

/** A coordinate of each sphere (m). */
function coordinates(frame: Received | undefined, axis: 0 | 1 | 2): number[] {
  return Array.from({ length: frame?.count ?? 0 }, (_, place) =>
    coordinate((frame as Received).columns.position, place, axis),
  );
}

const xs = (frame: Received | undefined): number[] => coordinates(frame, 0);
const firstY = (frame: Received | undefined): number | undefined => coordinates(frame, 1)[0];

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

test("a foreign file is refused with the reason", () => {
  const file = fileOf(past(3));
  const changed = (at: number, byte: number): Uint8Array => file.map((value, k) => (k === at ? byte : value));
  assert.throws(() => readRecording(new TextEncoder().encode("PK, no recording")), /is no recording/);
  assert.throws(() => readRecording(new Uint8Array(0)), /is no recording/);
  assert.throws(() => readRecording(changed(8, 2)), /version 2/);
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
