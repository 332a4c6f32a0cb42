import { create, toBinary } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { decode, forPage } from "../src/connection/protocol";
import {
  RecordingSchema,
  ServerMessageSchema,
  SettingsSchema,
  StreamSchema,
  TimelineSchema,
} from "../src/gen/spherule/v1/control_pb";
import { PopulationSchema } from "../src/gen/spherule/v1/facts_pb";
import type { ServerMessage } from "../src/gen/spherule/v1/control_pb";
import { frameOf, still } from "./support/chain";

function decoded(kind: ServerMessage["kind"]): ServerMessage["kind"] {
  return decode(toBinary(ServerMessageSchema, create(ServerMessageSchema, { kind })));
}

test("messages are passed to the page unchanged", () => {
  const settings = forPage(decoded({ case: "settings", value: create(SettingsSchema, { substeps: 8 }) }));
  assert.ok(settings?.kind === "settings" && settings.settings.substeps === 8);
  const slow = create(StreamSchema, { rate: 20, reduced: true, reason: "slow" });
  const stream = forPage(decoded({ case: "stream", value: slow }));
  assert.ok(stream?.kind === "stream");
  assert.deepEqual([stream.stream.rate, stream.stream.reduced, stream.stream.reason], [20, true, "slow"]);
  const played = create(TimelineSchema, { file: "a.sph", end: 2, frames: 61n });
  const timeline = forPage(decoded({ case: "timeline", value: played }));
  assert.ok(timeline?.kind === "timeline" && timeline.timeline.file === "a.sph" && timeline.timeline.frames === 61n);
  const changed = create(PopulationSchema, { number: 7, added: [{ first: 1, count: 2, id: 1n << 40n }] });
  const population = forPage(decoded({ case: "population", value: changed }));
  assert.ok(population?.kind === "population" && population.population.number === 7);
  assert.equal(population.population.added[0]?.id, 1n << 40n);
  const recorded = create(RecordingSchema, { active: true, bytes: 5n });
  const recording = forPage(decoded({ case: "recording", value: recorded }));
  assert.ok(recording?.kind === "recording" && recording.recording.active && recording.recording.bytes === 5n);
});

test("frames are not passed to the page before they are decoded", () => {
  assert.equal(forPage(decoded({ case: "frame", value: frameOf(still(1, 1)) })), undefined);
});

test("malformed bytes are refused", () => {
  assert.throws(() => decode(new Uint8Array([255, 255, 255])));
});

test("a message of an unknown kind is ignored", () => {
  assert.equal(forPage(decode(new Uint8Array(0))), undefined);
});
