import assert from "node:assert/strict";
import { test } from "node:test";
import { create } from "@bufbuild/protobuf";
import { DialSchema } from "../src/gen/spherule/v1/diagnostics_pb";
import { AutoSchema, Model } from "../src/gen/spherule/v1/scene_pb";
import { toAuto, fromAuto } from "../src/ui/auto_goal";
import { costFigures, errorFigures, impactLabels, mergeImpacts, nearest, substepLabel } from "../src/ui/dial_labels";
import type { Impacts } from "../src/ui/dial_labels";
import type { Figure } from "../src/ui/figures";

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
const settings = { step: 1 / 60, speed: 1 };
const valuesOf = (figures: Figure[]): string[] => figures.map(({ name, value }) => `${name}: ${value}`);

test("the nearest position is of the same model, and the nearest by the ratio of substeps", () => {
  assert.deepEqual(
    [8, 11, 12, 1000, 1].map((substeps) => nearest(dial, Model.BALANCED, substeps)),
    [1, 1, 2, 2, 1],
  );
  assert.equal(nearest(dial, Model.FAST, 1000), 0);
  assert.equal(nearest(dial, Model.ACCURATE, 8), -1);
});

test("errors are listed by importance, with their significant digits", () => {
  assert.deepEqual(valuesOf(errorFigures(balanced)), [
    "Overlap in piles: 0.33 %",
    "Bounce height: under 0.001 %",
    "Restitution: within 0.0012",
    "Slip to roll: within 1.1 %",
    "something new: within 50 %",
  ]);
});

test("the cost is proportional to the substeps, and shows whether the requested speed is reached", () => {
  const quick = ["Step time: about 4 ms", "Speed: holds real time"];
  assert.deepEqual(valuesOf(costFigures(balanced, 8, true, settings)), quick);
  const slow = ["Step time: roughly 40 ms", "Speed: runs at 0.42 × real time"];
  assert.deepEqual(valuesOf(costFigures(balanced, 80, false, settings)), slow);
  assert.equal(costFigures(balanced, 80, true, { ...settings, speed: 0.25 })[1]?.value, "holds the speed");
  assert.equal(costFigures(balanced, 8, true, { ...settings, speed: 8 })[1]?.value, "runs at 4.2 × real time");
  assert.deepEqual([1, 2, 1000].map(substepLabel), ["1 substep", "2 substeps", "1\u202f000 substeps"]);
});

test("a goal survives the conversion to a message and back", () => {
  const cases = [
    { auto: "time", goal: 16 },
    { auto: "overlap", goal: 0.7 },
    { auto: "off", goal: 0 },
  ] as const;
  for (const held of cases) {
    assert.deepEqual(fromAuto(create(AutoSchema, toAuto(held.auto, held.goal))), held);
  }
  assert.deepEqual(fromAuto(undefined), { auto: "off", goal: 0 });
});

test("impacts are shown with the specified restitution, and few impacts are averaged with earlier ones", () => {
  const of = (impacts: bigint, restitution?: number, restitutionAsked?: number): Impacts => ({
    impacts,
    restitution,
    restitutionAsked,
  });
  assert.deepEqual(impactLabels(of(1312n, 0.4978, 0.5)), { restitution: "0.498 of 0.5", over: "1\u202f312" });
  assert.deepEqual(impactLabels(undefined), { restitution: "–", over: "–" });
  assert.equal(mergeImpacts(undefined, of(0n)), undefined);
  const many = of(300n, 0.5, 0.5);
  assert.equal(mergeImpacts(many, of(0n)), many);
  assert.deepEqual(mergeImpacts(many, of(40n, 0.4, 0.5)), of(40n, 0.4, 0.5));
  assert.deepEqual(mergeImpacts(many, of(5n, 0, 0.5)), of(25n, 0.4, 0.5));
  assert.deepEqual(mergeImpacts(of(1n, 0.2, 0.5), of(1n, 0.4, 0.5)), of(2n, 0.30000000000000004, 0.5));
});
