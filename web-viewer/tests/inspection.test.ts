import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Outcome } from "../src/connection/link";
import { AppliedSchema, SettingsSchema } from "../src/gen/spherule/v1/control_pb";
import { Inspection } from "../src/model/inspection";
import { createSession } from "./support/session";

function begun() {
  const { session, scene, frame } = createSession();
  session.handle({ kind: "link", state: "open", at: 0 });
  scene({ count: 1 });
  frame(0, [0]);
  const asked: number[] = [];
  let resolve: (outcome: Outcome) => void = () => undefined;
  const inspection = new Inspection(session, (id) => {
    asked.push(id);
    return new Promise((done) => (resolve = done));
  });
  const answer = async (radius: number): Promise<void> => {
    resolve({ case: "applied", value: create(AppliedSchema, { inspected: { radius } }) });
    await new Promise((done) => setImmediate(done));
  };
  return { session, frame, inspection, asked, answer, refuse: () => resolve({ case: "lost" }) };
}

test("while a sphere is selected, its state is asked for four times a second, one question at a time", async () => {
  const { inspection, asked, answer } = begun();
  assert.equal(inspection.update(undefined, 1000), undefined);
  assert.deepEqual(asked, []);
  for (let now = 1000; now < 3000; now += 10) inspection.update(7, now);
  assert.deepEqual(asked, [7], "the first question has no answer yet");
  for (let now = 3000; now < 4000; now += 10) {
    await answer(2);
    inspection.update(7, now);
  }
  assert.equal(asked.length, 5);
});

test("a paused world is asked once for each of its states", async () => {
  const { session, frame, inspection, asked, answer } = begun();
  session.handle({ kind: "settings", settings: create(SettingsSchema, { paused: true }) });
  inspection.update(7, 1000);
  await answer(1);
  for (let now = 1000; now < 9000; now += 100) assert.equal(inspection.update(7, now)?.radius, 1);
  assert.deepEqual(asked, [7]);
  frame(0, [1]);
  inspection.update(7, 9000);
  assert.deepEqual(asked, [7, 7]);
});

test("an answer is shown only while it is the present state of the selected sphere", async () => {
  const { session, inspection, answer } = begun();
  const known = (id: number | undefined, now: number): number | undefined => inspection.update(id, now)?.radius;
  known(7, 1000);
  await answer(1);
  assert.equal(known(7, 1100), 1);
  assert.equal(known(8, 1100), undefined, "of another sphere");
  await answer(2);
  assert.equal(known(8, 1200), 2);
  known(8, 1400); // a question that is not answered
  assert.equal(known(8, 2500), 2);
  assert.equal(known(8, 2700), undefined, "of an earlier time");
  await answer(3);
  assert.equal(known(8, 2800), 3);
  session.handle({ kind: "replay", replay: { source: "past", paused: false } });
  assert.equal(known(8, 2800), undefined, "the past is shown");
  session.handle({ kind: "replay", replay: undefined });
  known(8, 3000);
  await answer(4);
  assert.equal(known(8, 3000), 4);
  session.handle({ kind: "link", state: "waiting", at: 0 });
  assert.equal(known(8, 3000), undefined, "no connection");
});
