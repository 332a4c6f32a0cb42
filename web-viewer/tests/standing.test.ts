import assert from "node:assert/strict";
import { test } from "node:test";
import { create } from "@bufbuild/protobuf";
import { ControlSchema, Role } from "../src/gen/spherule/v1/control_pb";
import type { Control } from "../src/gen/spherule/v1/control_pb";
import { namesOf, wordsFor } from "../src/scene/names";
import { answerTo, hindranceOf, standingOf } from "../src/scene/standing";
import type { Standing } from "../src/scene/standing";

const names: Record<number, string> = { 1: "spherule viewer", 2: "spherule viewer", 3: "spherule ctl", 4: "spherule ctl" };
const person = (session: number, client = names[session] ?? "") => ({ session: BigInt(session), client });

function control(holder: number | undefined, ...asking: number[]): Control {
  return create(ControlSchema, { holder: holder === undefined ? undefined : person(holder), asking: asking.map((one) => person(one)) });
}

/** As session 1 sees it. */
const seen = (said: Control | undefined, role = Role.CONTROLLER): Standing => standingOf({ welcome: { role, session: 1n }, control: said });
const calls = (...people: ReturnType<typeof person>[]): string[] => namesOf(create(ControlSchema, { asking: people }).asking).map(wordsFor);

test("where the server says nothing of control, everybody steers", () => {
  assert.deepEqual(standingOf({ welcome: undefined, control: undefined }), { kind: "everybody" });
  assert.deepEqual(seen(undefined), { kind: "everybody" });
  assert.equal(hindranceOf(seen(undefined)), "");
});

test("a viewer watches, whoever has the controls", () => {
  for (const said of [undefined, control(undefined), control(2)]) assert.deepEqual(seen(said, Role.VIEWER), { kind: "watching" });
  assert.match(hindranceOf({ kind: "watching" }), /watch/);
});

test("controls that nobody has hinder nobody", () => {
  assert.deepEqual(seen(control(undefined)), { kind: "free" });
  assert.equal(hindranceOf(seen(control(undefined))), "");
});

test("the holder sees who asks, longest first", () => {
  const now = seen(control(1, 3, 2));
  assert.equal(now.kind, "mine");
  assert.deepEqual(now.kind === "mine" && now.asking.map(wordsFor), ["spherule ctl", "spherule viewer #2"]);
  assert.equal(hindranceOf(now), "");
});

test("others see who has them, and whether they have asked", () => {
  const now = seen(control(3, 2));
  assert.equal(hindranceOf(now), "spherule ctl has the controls");
  assert.equal(now.kind === "taken" && now.asked, false);
  const asked = seen(control(2, 3, 1));
  assert.equal(asked.kind === "taken" && asked.asked, true);
  assert.equal(hindranceOf(asked), "spherule viewer #2 has the controls");
});

test("who asked is told what came of it", () => {
  const asked = seen(control(3, 1));
  assert.deepEqual(answerTo(asked, seen(control(1))), { granted: true, words: "You have the controls" });
  assert.deepEqual(answerTo(asked, seen(control(3))), { granted: false, words: "spherule ctl keeps the controls" });
  assert.equal(answerTo(asked, seen(control(3, 1, 2))), undefined);
  assert.equal(answerTo(asked, seen(control(2, 1))), undefined, "another one has got them, and is asked now");
  assert.equal(answerTo(asked, seen(undefined)), undefined, "the connection is gone");
  assert.equal(answerTo(seen(control(3)), seen(control(1))), undefined, "it was not asked");
});

test("the same name twice, or this page's own, comes with a number", () => {
  assert.deepEqual(calls(person(2), person(3), person(5, "other")), ["spherule viewer #2", "spherule ctl", "other"]);
  assert.deepEqual(calls(person(3), person(4)), ["spherule ctl #3", "spherule ctl #4"]);
  assert.deepEqual(calls(person(5, "other"), person(6, "other\u200b ")), ["other #5", "other #6"]);
});

test("names neither hide, nor turn what stands around them, nor fill the page", () => {
  assert.deepEqual(calls(person(7, " \n ")), ["somebody #7"]);
  assert.deepEqual(calls(person(7, "a\u202eb\n\tc\u0000")), ["a b c"]);
  assert.deepEqual(calls(person(7, "<b>bold</b>")), ["<b>bold</b>"]);
  const [long = ""] = calls(person(7, "🎱".repeat(500)));
  assert.equal([...long].length, 40);
  assert.match(long, /🎱…$/u);
});
