import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { RecordingSchema } from "../src/gen/spherule/v1/control_pb";
import { recordingEnd } from "../src/ui/record";

test("the end of a recording is reported once, with its file or the reason", () => {
  const active = create(RecordingSchema, { active: true, file: "r/a.sph" });
  const done = { ...active, active: false };
  const text = "Play it with spherule play r/a.sph";
  assert.deepEqual(recordingEnd(done, active), { title: "Recorded", text, failed: false, file: "a.sph" });
  assert.equal(recordingEnd(done, done), undefined);
  assert.equal(recordingEnd(done, undefined), undefined); // it ended before the page connected
  assert.equal(recordingEnd(active, done), undefined);
  const full = { ...done, failure: "the disk is full" };
  const ended = { title: "Recording ended", text: "the disk is full", failed: true, file: "a.sph" };
  assert.deepEqual(recordingEnd(full, active), ended);
  assert.equal(recordingEnd(full, full), undefined);
  assert.equal(recordingEnd(full, done)?.failed, true); // it ended right after its start
});
