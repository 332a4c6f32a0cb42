import { create, toBinary } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { checksumBytes, entryBytes, headBytes, indexHeadBytes, Kind, recordHeadBytes } from "../../src/archive/format";
import { recordOf, trailerBytes, trailerOf, viewOf } from "../../src/archive/format";
import { readRecording } from "../../src/archive/recording_reader";
import { RecordingWriter } from "../../src/archive/recording_writer";
import { BufferPool } from "../../src/connection/buffer_pool";
import { Frames } from "../../src/connection/frames";
import { History } from "../../src/connection/history";
import type { Segment } from "../../src/connection/history";
import { LookBack } from "../../src/connection/look_back";
import type { Received } from "../../src/connection/messages";
import { Player } from "../../src/connection/player";
import { ServerMessageSchema, SettingsSchema } from "../../src/gen/spherule/v1/control_pb";
import { PlacesSchema, PopulationSchema, SceneFactsSchema } from "../../src/gen/spherule/v1/facts_pb";
import type { SceneFacts } from "../../src/gen/spherule/v1/facts_pb";
import { coordinate } from "../../src/model/units";
import { frameOf, keyframe, moved, orderOf } from "./chain";

/**
 * A past with four places. The second is free before the 50th frame, and the third from the 100th on. `stride`: how far
 * each sphere moves along y between two frames, in half metres.
 */
export function past(frames = 300, stride = 1): readonly Segment[] {
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
    const spb = number === 1 ? first() : moved(number, 4, [0, stride, 0]);
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

export function fileOf(segments: readonly Segment[]): Uint8Array {
  const writer = new RecordingWriter(undefined);
  for (const segment of segments) writer.add(segment);
  writer.finish();
  return new Uint8Array(Buffer.concat(writer.parts));
}

/** A finished recording, in parts. */
interface Parts {
  head: Uint8Array;
  records: Uint8Array[]; // with the index
  trailer: Uint8Array;
}

export function partsOf(file: Uint8Array): Parts {
  const last = file.byteLength - trailerBytes;
  const records: Uint8Array[] = [];
  for (let at = headBytes; at < last;) {
    const end = at + recordHeadBytes + viewOf(file).getUint32(at, true) + checksumBytes;
    records.push(file.subarray(at, end));
    at = end;
  }
  return { head: file.subarray(0, headBytes), records, trailer: file.subarray(last) };
}

export function joined({ head, records, trailer }: Parts): Uint8Array {
  return new Uint8Array(Buffer.concat([head, ...records, trailer]));
}

/** The same recording with a record of a log before the first record, and behind each tenth one. */
export function withLogs(file: Uint8Array): Uint8Array {
  const { head, records } = partsOf(file);
  const own = { version: viewOf(head).getUint32(8, true), id: viewOf(head).getUint32(12, true) };
  const written: Uint8Array[] = [];
  let length = headBytes;
  const write = (kind: number, time: number, payload: Uint8Array): void => {
    const record = recordOf(kind, time, payload, own, length);
    written.push(record);
    length += record.byteLength;
  };
  const writeLog = (time: number): void => {
    const random = Uint8Array.from({ length: written.length % 70 }, (_, k) => 41 * k + written.length);
    write(Kind.log, time, random);
  };
  const moved = new Map<number, number>(); // offsets before and now
  let before = headBytes;
  let trailer = new Uint8Array(0);
  writeLog(viewOf(records[0] as Uint8Array).getFloat64(8, true));
  records.forEach((record, number) => {
    const kind = viewOf(record).getUint32(4, true);
    const time = viewOf(record).getFloat64(8, true);
    const payload = record.slice(recordHeadBytes, -checksumBytes);
    if (kind === Kind.index) {
      const index = viewOf(payload);
      for (let at = indexHeadBytes; at < payload.byteLength; at += entryBytes) {
        index.setBigUint64(at, BigInt(moved.get(Number(index.getBigUint64(at, true))) as number), true);
      }
      trailer = trailerOf(length);
    }
    moved.set(before, length);
    before += record.byteLength;
    write(kind, time, payload);
    if (number % 10 === 9 && kind !== Kind.index) writeLog(time);
  });
  return joined({ head, records: written, trailer });
}

/** What a player shows of the file. */
export function played(bytes: Uint8Array) {
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
export function coordinates(frame: Received | undefined, axis: 0 | 1 | 2): number[] {
  return Array.from({ length: frame?.count ?? 0 }, (_, place) =>
    coordinate((frame as Received).columns.position, place, axis),
  );
}

export const xs = (frame: Received | undefined): number[] => coordinates(frame, 0);
export const firstY = (frame: Received | undefined): number | undefined => coordinates(frame, 1)[0];
