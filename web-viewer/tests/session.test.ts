import assert from "node:assert/strict";
import { test } from "node:test";
import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import { SettingsSchema } from "../src/gen/spherule/v1/control_pb";
import { createSession } from "./support/session";

const arrival = 100; // ms, of the first frame

/** How stale the image is `age` ms after the only frame. */
function staleness(age: number, settings: MessageInitShape<typeof SettingsSchema>, open = true): number {
  const { session, scene, frame } = createSession();
  if (open) session.handle({ kind: "link", state: "open", at: 0 });
  scene();
  session.handle({ kind: "settings", settings: create(SettingsSchema, settings) });
  frame(0, [0.5]);
  return session.staleness(arrival + age);
}

test("an image is stale some seconds after its frame, and sooner without a connection", () => {
  const settings = { step: 1 / 60, speed: 1 };
  assert.equal(staleness(4999, settings), 0);
  assert.equal(staleness(5600, settings), 1);
  assert.equal(staleness(400, settings, false), 0);
  assert.equal(staleness(1000, settings, false), 1);
});

test("the image of a paused world is not stale", () => {
  assert.equal(staleness(1e9, { step: 1 / 60, speed: 1, paused: true }), 0);
});

test("the image of a slow world is not stale before its next frame is long overdue", () => {
  const settings = { step: 0.1, speed: 0.01 }; // 10 s from one frame to the next
  assert.equal(staleness(19_999, settings), 0);
  assert.equal(staleness(20_600, settings), 1);
});
