import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { Axis } from "../src/gen/spherule/v1/scene_pb";
import { factsOf } from "../src/model/facts";
import type { Shown, State } from "../src/model/states";
import { capacity, Trace } from "../src/model/trace";
import { positionsAt } from "./support/session";

const bounds = { boundsMin: [0, 0, 0], boundsMax: [4, 2, 2] };
const facts = factsOf(create(SceneFactsSchema, { epoch: 1, count: 2, radius: 0.1, ...bounds }));
const looped = factsOf(create(SceneFactsSchema, { epoch: 1, count: 2, radius: 0.1, ...bounds, periodic: [Axis.X] }));

/** Sphere 1 is at x (m from the centre of the bounds); sphere 0 rests. */
function stateAt(simTime: number, x: number): State {
  const columns = { position: positionsAt([0, 0, 0, x, 0.5, 0], 2 ** -12) };
  const drawing = { order: 1, boxes: new Float64Array(6), poses: [] };
  return { sequence: 1, epoch: 1, step: 1, simTime, count: 2, columns, ...drawing };
}

const between = (from: State, to: State, mix: number): Shown => ({ from, to, mix, moving: true });

/** The x of begin and end of each segment. */
function xsOf({ segments, length }: Trace): number[][] {
  return Array.from({ length }, (_, k) => [segments[6 * k] as number, segments[6 * k + 3] as number]);
}

test("the path joins the states that were shown, and ends at the sphere", () => {
  const trace = new Trace();
  const states = [0, 1, 2, 3].map((time) => stateAt(time, -1 + 0.5 * time));
  for (const [k, from] of states.slice(0, 3).entries()) {
    for (const mix of [0.25, 0.75]) trace.update(facts, between(from, states[k + 1] as State, mix), 1, 1);
  }
  assert.deepEqual(xsOf(trace), [
    [-1, -0.5],
    [-0.5, 0],
  ]);
  assert.deepEqual([...trace.end], [0.375, 0.5, 0]);
});

test("another sphere, no sphere, and an earlier time begin another path", () => {
  const trace = new Trace();
  const [a, b, c] = [stateAt(5, 0), stateAt(6, 0.5), stateAt(1, 1)];
  const advance = (): void => {
    trace.update(facts, between(a, b, 0.5), 1, 1);
    trace.update(facts, between(b, b, 1), 1, 1);
  };
  for (const interrupt of [
    () => trace.update(facts, between(a, b, 0.5), 0, 0),
    () => trace.update(facts, between(a, b, 0.5), undefined, undefined),
    () => trace.update(facts, between(c, c, 1), 1, 1),
    () => trace.update({ ...facts, epoch: 2 }, between(b, b, 1), 1, 1),
  ]) {
    advance();
    assert.equal(xsOf(trace).length, 1);
    const { run } = trace;
    interrupt();
    assert.ok(trace.run > run && trace.length === 0);
    trace.update(facts, undefined, 1, 1);
  }
  assert.equal(trace.known, false);
});

test("a path does not cross the scene where the sphere passes a seam", () => {
  const trace = new Trace();
  const states = [1.4, 1.9, -1.6, -1.1].map((x, k) => stateAt(k, x));
  for (const state of states) trace.update(looped, between(state, state, 0), 1, 1);
  assert.equal(trace.length, 2);
  assert.ok(xsOf(trace).every(([from = 0, to = 9]) => Math.abs(to - from) < 0.51));
});

test("the newest segments replace the oldest ones", () => {
  const trace = new Trace();
  for (let k = 0; k <= capacity + 10; k++) {
    const state = stateAt(k, k / 4096);
    trace.update(facts, between(state, state, 0), 1, 1);
  }
  assert.equal(trace.length, capacity + 10);
  assert.equal(trace.segments[6 * 9 + 3], (capacity + 10) / 4096);
  assert.equal(trace.segments[6 * 10], 10 / 4096);
});
