import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { Refused_Cause as Cause, RefusedSchema } from "../src/gen/spherule/v1/refused_pb";
import { refusalText } from "../src/ui/refusals";

const text = (refused: MessageInitShape<typeof RefusedSchema>): string => refusalText(create(RefusedSchema, refused));

test("a refusal says in the words of the page what to do", () => {
  const fill = "spawn.group.fill.count";
  assert.equal(
    text({ cause: Cause.NO_ROOM, field: fill, reason: "asks for 9000 spheres", most: 3000 }),
    "Too many spheres: at most 3\u202f000 fit in the free space. Drop fewer.",
  );
  assert.match(text({ cause: Cause.NO_ROOM, field: fill, reason: "no", most: 0 }), /^There is no free place/);
  assert.equal(
    text({ cause: Cause.RANGE, field: "push.impulse", reason: "is 1000 N s", least: 0, most: 12.345 }),
    "Impulse: give a number from 0 to 12.3\u00a0N s.",
  );
  assert.equal(
    text({ cause: Cause.RANGE, field: "set.gravity", reason: "is long", most: 1e6 }),
    "Gravity: give a number of at most 1\u202f000\u202f000\u00a0m/s².",
  );
  assert.equal(
    text({ cause: Cause.TOO_LARGE, field: "spawn.group.fill", reason: "is narrow", most: 0.25 }),
    "The spheres are too large. Give a radius of at most 0.25\u00a0m.",
  );
});

test("every cause has words that speak of no field, message or option", () => {
  for (const cause of Object.values(Cause)) {
    if (typeof cause !== "number" || cause === Cause.CAUSE_UNSPECIFIED || cause === Cause.RANGE) continue;
    const words = text({ cause, field: "set.x", reason: "--option: set.field" });
    assert.doesNotMatch(words, /--|set\.|undefined/, Cause[cause]);
    assert.match(words, /^[A-Z].*\.$/, Cause[cause]);
  }
});

test("a refusal without a known cause or limit keeps the words of the server", () => {
  assert.equal(text({ reason: "there is no such thing" }), "There is no such thing.");
  assert.equal(text({ cause: 999 as Cause, reason: "is new" }), "Is new.");
  assert.equal(text({ cause: Cause.RANGE, field: "set.speed", reason: "is wrong" }), "Is wrong.");
  assert.equal(text({ cause: Cause.RANGE, field: "load.scene.step", reason: "is 3", most: 1 }), "Is 3.");
});
