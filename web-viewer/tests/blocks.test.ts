import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { Camera } from "../src/camera/camera";
import type { View } from "../src/camera/view";
import { blockPlaces } from "../src/columns";
import { boxesOf } from "../src/connection/order";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { everything } from "../src/model/cut";
import type { HalfSpace } from "../src/model/cut";
import { factsOf } from "../src/model/facts";
import type { Vec3 } from "../src/model/facts";
import type { Shown, State } from "../src/model/states";
import { Detail, SphereBlocks } from "../src/renderer/blocks";
import type { DrawState } from "../src/renderer/draw_state";
import { pixelOf } from "../src/renderer/frame_uniforms";
import { positionsAt } from "./support/session";

const places = 3 * blockPlaces - 100;
const bounds = { boundsMin: [-100, -100, -100], boundsMax: [100, 100, 100] };
const camera = { eye: [0, -50, 0], target: [0, 0, 0], fieldOfView: 30 };
const facts = factsOf(create(SceneFactsSchema, { epoch: 1, count: places, radius: 0.5, ...bounds, camera }));
const order = { epoch: 1, number: 4, places: Uint32Array.from({ length: places }, (_, k) => k) };

/** A state whose blocks have these centres, and a size of 2 m. */
function state(number: number, ...centres: Vec3[]): State {
  const boxes = Float64Array.from(centres.flatMap((at) => [...at.map((x) => x - 1), ...at.map((x) => x + 1)]));
  const columns = { position: positionsAt(new Array<number>(3 * places).fill(0)) };
  return { sequence: 1, epoch: 1, step: 1, simTime: 0, count: places, columns, order: number, boxes, poses: [] };
}

function viewFrom(orthographic = false): { view: View; eye: Vec3; pixel: number } {
  const seen = new Camera();
  seen.orthographic = orthographic;
  seen.resize(800, 600);
  seen.look(facts, false);
  const view = seen.view();
  return { view, eye: view.eye, pixel: pixelOf(view, 600) };
}

function drawn(view: View, kept = everything): DrawState {
  return { view, kept, mode: "speed", turns: false, range: [0, 1], selected: undefined, trace: undefined, dim: 0 };
}

/** First block, number of spheres and detail of each run. */
function found(shown: Shown, orthographic = false, kept = everything): [number, number, Detail][] {
  const blocks = new SphereBlocks();
  blocks.set(facts, order);
  const { view, eye, pixel } = viewFrom(orthographic);
  blocks.find(shown, places, drawn(view, kept), eye, pixel);
  return blocks.runs.slice(0, blocks.length).map(({ first, count, detail }) => [first / blockPlaces, count, detail]);
}

const still = (of: State): Shown => ({ from: of, to: of, mix: 1, moving: false });
const last = places - 2 * blockPlaces;

test("blocks outside of the view are not drawn, and equal neighbours are drawn together", () => {
  for (const orthographic of [false, true]) {
    const see = (...centres: Vec3[]): [number, number, Detail][] => found(still(state(4, ...centres)), orthographic);
    assert.deepEqual(see([0, 0, 0], [1, 0, 0], [2, 0, 0]), [[0, places, Detail.Disc]]);
    assert.deepEqual(see([0, 0, 0], [90, 0, 0], [2, 0, 0]), [
      [0, blockPlaces, Detail.Disc],
      [2, last, Detail.Disc],
    ]);
    assert.deepEqual(see([0, 0, 90], [0, 0, -90], [-90, 0, 0]), []);
  }
  const behind = found(still(state(4, [0, -60, 0], [0, 0, 0], [0, 0, 0])));
  assert.deepEqual(behind, [[1, places - blockPlaces, Detail.Disc]]);
});

test("a block between its places in two states is drawn", () => {
  const from = state(4, [-90, 0, 0], [-90, 0, 0], [-90, 0, 0]);
  const to = state(4, [90, 0, 0], [-90, 0, 0], [-90, 0, 0]);
  assert.deepEqual(found({ from, to, mix: 0.5, moving: true }), [[0, blockPlaces, Detail.Disc]]);
});

test("near spheres are drawn round, and far ones as points", () => {
  const near = found(still(state(4, [0, -45, 0], [0, 0, 0], [0, 0, 0])));
  assert.deepEqual(near, [
    [0, blockPlaces, Detail.Round],
    [1, places - blockPlaces, Detail.Disc],
  ]);
  const small = factsOf(create(SceneFactsSchema, { epoch: 1, count: places, radius: 0.01, ...bounds, camera }));
  const blocks = new SphereBlocks();
  blocks.set(small, order);
  const { view, eye, pixel } = viewFrom();
  blocks.find(still(state(4, [0, 0, 0], [0, 0, 0], [0, 0, 0])), places, drawn(view), eye, pixel);
  assert.deepEqual([blocks.length, blocks.runs[0]?.detail], [1, Detail.Point]);
});

test("blocks beyond the plane of a cut are not drawn, and blocks that it meets are drawn round", () => {
  const shown = still(state(4, [-10, 0, 0], [0, 0, 0], [10, 0, 0]));
  const low: HalfSpace = { normal: [1, 0, 0], offset: 0.2 };
  assert.deepEqual(found(shown, false, low), [
    [0, blockPlaces, Detail.Disc],
    [1, blockPlaces, Detail.Round],
  ]);
  const high: HalfSpace = { normal: [-1, 0, 0], offset: 9 };
  assert.deepEqual(found(shown, false, high), [
    [0, blockPlaces, Detail.Round],
    [1, places - blockPlaces, Detail.Disc],
  ]);
});

test("without boxes of the present order, all spheres are drawn round", () => {
  assert.deepEqual(found(still(state(3, [0, 0, 90], [0, 0, 90], [0, 0, 90]))), [[0, places, Detail.Round]]);
});

test("one giant makes its own block round, not the others", () => {
  const radii = new Float32Array(places).fill(0.5);
  radii[blockPlaces] = 20;
  const mixed = { radius: 0, radii: new Uint8Array(radii.buffer) };
  const giant = factsOf(create(SceneFactsSchema, { epoch: 1, count: places, ...mixed, ...bounds, camera }));
  const blocks = new SphereBlocks();
  blocks.set(giant, order);
  const { view, eye, pixel } = viewFrom();
  blocks.find(still(state(4, [0, 0, 0], [0, 0, 0], [0, 0, 0])), places, drawn(view), eye, pixel);
  const details = blocks.runs.slice(0, blocks.length).map(({ detail }) => detail);
  assert.deepEqual(details, [Detail.Disc, Detail.Round, Detail.Disc]);
});

test("the boxes of blocks hold the positions, and are unbounded along periodic axes", () => {
  const count = blockPlaces + 3;
  const units = Int32Array.from({ length: 3 * count }, (_, k) => ((k * 7919) % 2001) - 1000);
  units.set([5, -6, 7, 5, -8, 9, 5, -7, 8], 3 * blockPlaces);
  const boxes = new Float64Array(12);
  boxesOf(units, count, [0.5, 0.25, 1], [0, 0, 0], boxes);
  assert.deepEqual([...boxes.subarray(6)], [2.5, -2, 7, 2.5, -1.5, 9]);
  for (let k = 0; k < blockPlaces; k++) {
    for (const [axis, quantum] of [0.5, 0.25, 1].entries()) {
      const value = quantum * (units[3 * k + axis] as number);
      assert.ok(value >= (boxes[axis] as number) && value <= (boxes[3 + axis] as number));
    }
  }
  boxesOf(units, count, [0.5, 0.25, 1], [0, 4, 0], boxes);
  assert.deepEqual([...boxes.subarray(6)], [2.5, -Infinity, 7, 2.5, Infinity, 9]);
});
