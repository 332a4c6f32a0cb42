import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { Quantity } from "../src/gen/spherule/v1/frame_pb";
import { Axis } from "../src/gen/spherule/v1/scene_pb";
import { highOf } from "../src/model/colour_ranges";
import { factsOf } from "../src/model/facts";
import { positionOf, sentValue, shownPosition, shownSpeed, speedOf } from "../src/model/positions";
import type { Shown, State } from "../src/model/states";
import { copyPositions } from "../src/model/units";
import { positionsAt } from "./support/session";

const facts = factsOf(
  create(SceneFactsSchema, {
    epoch: 3,
    count: 2,
    boundsMin: [-2, 0, 0],
    boundsMax: [1, 1, 4],
    radii: new Uint8Array(new Float32Array([0.5, 0.25]).buffer),
    obstacles: [{ shape: { case: "plane", value: { point: [0, 0, 0], normal: [0, 3, 4] } } }],
  }),
);

function state(simTime: number, metres: number[], quantum = 0.25): State {
  const position = positionsAt(metres, quantum);
  const drawing = { order: 1, boxes: new Float64Array(0), poses: [] };
  return { sequence: 1, epoch: 3, step: 1, simTime, count: metres.length / 3, columns: { position }, ...drawing };
}

test("a position is relative to the centre of the bounds", () => {
  assert.deepEqual(positionOf(facts, state(2, [0, 0, 0, 1, 2, 3]), 1), [0.5, 2.5, 5]);
});

test("a position far from the centre of the bounds is as exact as its quantum", () => {
  const far = state(2, [0, 0, 0, 4e5 + 0.001, -4e5, 4e5 - 0.003], 0.001);
  const error = positionOf(facts, far, 1).map((x, axis) => x - ([4e5 - 0.499, -4e5 + 0.5, 4e5 + 1.997][axis] ?? NaN));
  assert.ok(
    error.every((part) => Math.abs(part) < 1e-9),
    String(error),
  );
});

test("positions are copied to a state with other quanta as its nearest units", () => {
  const from = positionsAt([1, 2, 3, -0.375, 0.625, 1.25], 0.125);
  const to = positionsAt([0, 0, 0, 0, 0, 0], 0.5);
  copyPositions(from, to, { first: 1, count: 1 });
  assert.deepEqual([...to.values], [0, 0, 0, -1, 1, 3]);
  copyPositions(from, to, { first: 0, count: 1 });
  assert.deepEqual([...to.values], [2, 4, 6, -1, 1, 3]);
  const far = positionsAt([2 ** 27, -(2 ** 27), 0], 0.125);
  const fine = positionsAt([0, 0, 0], 0.0625);
  copyPositions(far, fine, { first: 0, count: 1 });
  assert.deepEqual([...fine.values], [2 ** 30 - 1, 1 - 2 ** 30, 0], "the ends of the codec's grid");
});

test("between states with different quanta, a sphere is where their positions say", () => {
  const shown = {
    from: state(1, [0, 0, 0, 0.75, -1.5, 2.25], 0.75),
    to: state(2, [0, 0, 0, 1, -1, 2]),
    mix: 0.5,
    moving: true,
  };
  assert.deepEqual(shownPosition(facts, shown, 1), [0.375, -0.75, 4.125]);
});

test("radii are read as float32", () => {
  assert.deepEqual(
    [0, 1].map((place) => facts.population.radiusOf(place)),
    [0.5, 0.25],
  );
  assert.deepEqual(facts.population.radiusRange, [0.25, 0.5]);
});

function between(from: State, to: State, mix = 1): Shown {
  return { from, to, mix, moving: false };
}

test("without speeds of the server, a speed is the distance between two states over their time", () => {
  const from = state(2, [0, 0, 0, 0, 0, 0]);
  const to = state(4, [0, 0, 0, 3, 4, 0]);
  const error = (Math.sqrt(3) / 2) * 0.25; // both positions are off by half a quantum on each axis
  assert.deepEqual(shownSpeed(facts, between(from, to), 1), { speed: 2.5, error });
  assert.deepEqual(shownSpeed(facts, between(from, to), 0), { speed: 0, error });
  assert.equal(shownSpeed(facts, between(from, from), 1), undefined, "no time has passed");
});

test("speeds of the server are shown, also of a single state", () => {
  const withSpeeds = (simTime: number, speeds: number[]): State => {
    const one = state(simTime, [0, 0, 0, 0, 0, 0]);
    const value = { values: Float32Array.from(speeds), quantum: 0.001, quantity: Quantity.SPEED };
    return { ...one, columns: { ...one.columns, value } };
  };
  const from = withSpeeds(2, [0, 1]);
  assert.deepEqual(shownSpeed(facts, between(from, withSpeeds(4, [0, 3]), 0.25), 1), { speed: 1.5, error: 0 });
  assert.deepEqual(shownSpeed(facts, between(from, from), 1), { speed: 1, error: 0 });
  assert.equal(shownSpeed(facts, between(from, state(4, [0, 0, 0, 3, 4, 0])), 1)?.speed, 2.5, "one state has none");
});

test("a quantity of the server is known only if both states have it", () => {
  const having = (quantity: Quantity, values: number[]): State => {
    const one = state(2, [0, 0, 0, 0, 0, 0]);
    return { ...one, columns: { ...one.columns, value: { values: Float32Array.from(values), quantum: 1, quantity } } };
  };
  const from = having(Quantity.CONTACTS, [4, 8]);
  assert.equal(sentValue(Quantity.CONTACTS, between(from, having(Quantity.CONTACTS, [6, 9]), 0.5), 0), 5);
  assert.ok(Number.isNaN(sentValue(Quantity.CONTACTS, between(from, having(Quantity.OVERLAP, [6, 9])), 0)));
  assert.ok(Number.isNaN(sentValue(Quantity.OVERLAP, between(from, from), 0)));
  assert.ok(Number.isNaN(sentValue(Quantity.CONTACTS, between(from, state(4, [0, 0, 0])), 0)));
  const still = between(from, from);
  assert.equal(shownSpeed(facts, still, 0), undefined, "numbers of contacts are no speeds");
});

test("the high speed ignores the fastest spheres", () => {
  const many = Array.from({ length: 64 }, (_, id) => [0, 0, id === 63 ? 1000 : id]).flat();
  const from = state(
    2,
    many.map(() => 0),
  );
  const to = state(2.5, many);
  assert.equal(
    highOf((id) => speedOf(facts, between(from, to), id), 64),
    122,
  );
  assert.equal(
    highOf((id) => speedOf(facts, between(from, from), id), 64),
    undefined,
  );
});

const torus = factsOf(
  create(SceneFactsSchema, {
    count: 1,
    boundsMin: [0, 0, 0],
    boundsMax: [4, 2, 2],
    radius: 0.25,
    periodic: [Axis.X, Axis.Z],
    cellSize: 0.5,
    cells: [6, 4, 4],
  }),
);

test("a sphere crosses a seam by the shortest way", () => {
  const from = state(1, [1.75, 0.5, 0]);
  const to = state(2, [-1.75, 0.75, 0]);
  const at = (mix: number): number[] => shownPosition(torus, { from, to, mix, moving: true }, 0);
  assert.deepEqual(at(0), [3.75, 1.5, 1]);
  assert.deepEqual(at(0.25), [3.875, 1.5625, 1]);
  assert.deepEqual(at(0.75), [0.125, 1.6875, 1]);
  assert.deepEqual(at(1), [0.25, 1.75, 1]);
  assert.equal(shownSpeed(torus, between(from, to), 0)?.speed, Math.hypot(0.5, 0.25));
});

test("cells fit the length of a periodic axis", () => {
  assert.deepEqual(torus.cellWidths, [4 / 6, 0.5, 0.5]);
});
