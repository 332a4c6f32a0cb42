import assert from "node:assert/strict";
import { test } from "node:test";
import { create } from "@bufbuild/protobuf";
import { DialSchema } from "../src/gen/spherule/v1/control_pb";
import { AutoSchema, Model } from "../src/gen/spherule/v1/scene_pb";
import { goalFrom, heldBy } from "../src/ui/auto";
import { costRows, errorRows, impactWords, moreImpacts, nearest, substepWords } from "../src/ui/dial_words";
import type { Impacts } from "../src/ui/dial_words";

const dial = create(DialSchema, {
  positions: [
    { model: Model.FAST, substeps: 2, stepMs: 1 },
    {
      model: Model.BALANCED,
      substeps: 8,
      stepMs: 4,
      errors: [
        { curve: "slip to roll", error: 0.01073 },
        { curve: "something new", error: 0.5 },
        { curve: "restitution", error: 0.0012345 },
        { curve: "bounce apex", error: 1.7e-7 },
        { curve: "bed overlap", error: 0.003345 },
      ],
    },
    { model: Model.BALANCED, substeps: 16, stepMs: 8 },
  ],
});
const [, balanced] = dial.positions;
assert.ok(balanced);
const pace = { step: 1 / 60, speed: 1 };
const valuesOf = (rows: { name: string; value: string }[]): string[] => rows.map(({ name, value }) => `${name}: ${value}`);

test("the nearest position is of the same model, by the ratio of substeps", () => {
  assert.deepEqual([8, 11, 12, 1000, 1].map((substeps) => nearest(dial, Model.BALANCED, substeps)), [1, 1, 2, 2, 1]);
  assert.equal(nearest(dial, Model.FAST, 1000), 0);
  assert.equal(nearest(dial, Model.ACCURATE, 8), -1);
});

test("errors are told in the order in which they matter, with the digits that they have", () => {
  assert.deepEqual(valuesOf(errorRows(balanced)), [
    "Pile overlaps: 0.33 %",
    "Bounce height: under 0.001 %",
    "Restitution: within 0.0012",
    "Slip to roll: within 1.1 %",
    "something new: within 50 %",
  ]);
});

test("a cost goes with the substeps, and says whether the world keeps its pace", () => {
  assert.deepEqual(valuesOf(costRows(balanced, 8, true, pace)), ["A step here: about 4 ms", "So the world: holds real time"]);
  assert.deepEqual(valuesOf(costRows(balanced, 80, false, pace)), ["A step here: roughly 40 ms", "So the world: runs at 0.42 × real time"]);
  assert.equal(costRows(balanced, 80, true, { ...pace, speed: 0.25 })[1]?.value, "holds the speed");
  assert.equal(costRows(balanced, 8, true, { ...pace, speed: 8 })[1]?.value, "runs at 4.2 × real time");
  assert.deepEqual([1, 2, 1000].map(substepWords), ["1 substep", "2 substeps", "1\u202f000 substeps"]);
});

test("a goal is the same on its way to the server and back", () => {
  for (const held of [{ auto: "time", goal: 16 }, { auto: "overlap", goal: 0.7 }, { auto: "off", goal: 0 }] as const) {
    assert.deepEqual(heldBy(create(AutoSchema, goalFrom(held.auto, held.goal))), held);
  }
  assert.deepEqual(heldBy(undefined), { auto: "off", goal: 0 });
});

test("impacts are told with what was asked of them, and few together with those before", () => {
  const of = (impacts: bigint, restitution?: number, restitutionAsked?: number): Impacts => ({ impacts, restitution, restitutionAsked });
  assert.deepEqual(impactWords(of(1312n, 0.4978, 0.5)), { restitution: "0.498 of 0.5", over: "1\u202f312" });
  assert.deepEqual(impactWords(undefined), { restitution: "–", over: "–" });
  assert.equal(moreImpacts(undefined, of(0n)), undefined);
  const many = of(300n, 0.5, 0.5);
  assert.equal(moreImpacts(many, of(0n)), many);
  assert.deepEqual(moreImpacts(many, of(40n, 0.4, 0.5)), of(40n, 0.4, 0.5));
  assert.deepEqual(moreImpacts(many, of(5n, 0, 0.5)), of(25n, 0.4, 0.5));
  assert.deepEqual(moreImpacts(of(1n, 0.2, 0.5), of(1n, 0.4, 0.5)), of(2n, 0.30000000000000004, 0.5));
});
