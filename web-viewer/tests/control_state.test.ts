import assert from "node:assert/strict";
import { test } from "node:test";
import { create } from "@bufbuild/protobuf";
import { ControlSchema, Role } from "../src/gen/spherule/v1/control_pb";
import type { Control } from "../src/gen/spherule/v1/control_pb";
import { displayNames, nameText } from "../src/model/names";
import { controlAnswer, blockedReasonOf, controlStateOf } from "../src/model/control_state";
import type { ControlState } from "../src/model/control_state";

const names: Record<number, string> = {
  1: "spherule viewer",
  2: "spherule viewer",
  3: "spherule ctl",
  4: "spherule ctl",
};
const person = (session: number, client = names[session] ?? "") => ({ session: BigInt(session), client });

function control(holder: number | undefined, ...asking: number[]): Control {
  return create(ControlSchema, {
    holder: holder === undefined ? undefined : person(holder),
    asking: asking.map((one) => person(one)),
  });
}

/** The state as session 1 sees it. */
function seen(reported: Control | undefined, role = Role.CONTROLLER): ControlState {
  return controlStateOf({ welcome: { role, session: 1n }, control: reported });
}

function namesFor(...people: ReturnType<typeof person>[]): string[] {
  return displayNames(create(ControlSchema, { asking: people }).asking).map(nameText);
}

test("without a report about control, every client may send commands", () => {
  assert.deepEqual(controlStateOf({ welcome: undefined, control: undefined }), { kind: "unrestricted" });
  assert.deepEqual(seen(undefined), { kind: "unrestricted" });
  assert.equal(blockedReasonOf(seen(undefined)), "");
});

test("a viewer watches, whoever has control", () => {
  for (const reported of [undefined, control(undefined), control(2)]) {
    assert.deepEqual(seen(reported, Role.VIEWER), { kind: "watching" });
  }
  assert.match(blockedReasonOf({ kind: "watching" }), /watch/);
});

test("free control blocks no client", () => {
  assert.deepEqual(seen(control(undefined)), { kind: "free" });
  assert.equal(blockedReasonOf(seen(control(undefined))), "");
});

test("the holder sees the requests, the oldest first", () => {
  const now = seen(control(1, 3, 2));
  assert.equal(now.kind, "mine");
  assert.deepEqual(now.asking.map(nameText), ["spherule ctl", "spherule viewer #2"]);
  assert.equal(blockedReasonOf(now), "");
});

test("others see the holder, and whether they have requested control", () => {
  const now = seen(control(3, 2));
  assert.equal(blockedReasonOf(now), "spherule ctl has control");
  assert.equal(now.kind === "taken" && now.asked, false);
  const asked = seen(control(2, 3, 1));
  assert.equal(asked.kind === "taken" && asked.asked, true);
  assert.equal(blockedReasonOf(asked), "spherule viewer #2 has control");
});

test("a request gets an answer", () => {
  const asked = seen(control(3, 1));
  assert.deepEqual(controlAnswer(asked, seen(control(1))), { granted: true, text: "You have control" });
  assert.deepEqual(controlAnswer(asked, seen(control(3))), { granted: false, text: "spherule ctl keeps control" });
  assert.equal(controlAnswer(asked, seen(control(3, 1, 2))), undefined);
  assert.equal(controlAnswer(asked, seen(control(2, 1))), undefined, "the request now goes to another holder");
  assert.equal(controlAnswer(asked, seen(undefined)), undefined, "the connection is lost");
  assert.equal(controlAnswer(seen(control(3)), seen(control(1))), undefined, "there was no request");
});

test("a duplicate name, or this page's own, gets a number", () => {
  assert.deepEqual(namesFor(person(2), person(3), person(5, "other")), ["spherule viewer #2", "spherule ctl", "other"]);
  assert.deepEqual(namesFor(person(3), person(4)), ["spherule ctl #3", "spherule ctl #4"]);
  assert.deepEqual(namesFor(person(5, "other"), person(6, "other\u200b ")), ["other #5", "other #6"]);
});

test("names are never empty, keep the text direction, and are cut", () => {
  assert.deepEqual(namesFor(person(7, " \n ")), ["somebody #7"]);
  assert.deepEqual(namesFor(person(7, "a\u202eb\n\tc\u0000")), ["a b c"]);
  assert.deepEqual(namesFor(person(7, "<b>bold</b>")), ["<b>bold</b>"]);
  const [long = ""] = namesFor(person(7, "🎱".repeat(500)));
  assert.equal([...long].length, 40);
  assert.match(long, /🎱…$/u);
});
