import { create, toBinary } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { decode, forPage } from "../src/connection/decode";
import { RecordingSchema, ServerMessageSchema, SettingsSchema, StreamSchema, TimelineSchema } from "../src/gen/spherule/v1/control_pb";
import type { ServerMessage } from "../src/gen/spherule/v1/control_pb";
import { frameOf, still } from "./support/chain";

function decoded(kind: ServerMessage["kind"]): ServerMessage["kind"] {
  return decode(toBinary(ServerMessageSchema, create(ServerMessageSchema, { kind })).slice().buffer);
}

test("messages reach the page as they came", () => {
  const settings = forPage(decoded({ case: "settings", value: create(SettingsSchema, { substeps: 8 }) }));
  assert.ok(settings?.kind === "settings" && settings.settings.substeps === 8);
  const stream = forPage(decoded({ case: "stream", value: create(StreamSchema, { rate: 20, reduced: true, reason: "slow" }) }));
  assert.ok(stream?.kind === "stream" && stream.stream.rate === 20 && stream.stream.reduced && stream.stream.reason === "slow");
  const timeline = forPage(decoded({ case: "timeline", value: create(TimelineSchema, { file: "a.sph", end: 2, frames: 61n }) }));
  assert.ok(timeline?.kind === "timeline" && timeline.timeline.file === "a.sph" && timeline.timeline.frames === 61n);
  const recording = forPage(decoded({ case: "recording", value: create(RecordingSchema, { active: true, bytes: 5n }) }));
  assert.ok(recording?.kind === "recording" && recording.recording.active && recording.recording.bytes === 5n);
});

test("frames are not for the page before they are decoded", () => {
  assert.equal(forPage(decoded({ case: "frame", value: frameOf(still(1, 1)) })), undefined);
});

test("bytes that are no message are refused", () => {
  assert.throws(() => decode(new Uint8Array([255, 255, 255]).buffer));
});

test("a message of no known kind is left alone", () => {
  assert.equal(forPage(decode(new ArrayBuffer(0))), undefined);
});
