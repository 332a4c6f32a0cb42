import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { PopulationSchema, SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { factsOf } from "../src/model/facts";
import type { Vec3 } from "../src/model/facts";
import type { State } from "../src/model/states";
import { SphereData } from "../src/renderer/spheres";
import { Table } from "../src/renderer/table";
import { positionsAt } from "./support/session";

const places = 1000;
const eye: Vec3 = [0, 0, 0];
const groups = [{ name: "a", count: places }];
const scene = create(SceneFactsSchema, { epoch: 3, count: places, radius: 0.5, groups });

/** A WebGL context that does nothing but keep the uploads: the first place of each, and the number of places. */
function createContext() {
  const uploads: [first: number, count: number][] = [];
  const calls: Record<string, unknown> = {
    createTexture: () => ({}),
    texSubImage2D: (_: number, __: number, x: number, y: number, columns: number, rows: number) =>
      void uploads.push([2048 * y + x, columns * rows]),
  };
  const gl = new Proxy(calls, { get: (target, name: string) => target[name] ?? (() => undefined) });
  return { gl: gl as unknown as WebGL2RenderingContext, uploads };
}

function state(sequence: number): State {
  const columns = { position: positionsAt(new Array<number>(3 * places).fill(0)) };
  const drawing = { order: 1, boxes: new Float64Array(0), poses: [] };
  return { sequence, epoch: 3, step: sequence, simTime: sequence, count: places, columns, ...drawing };
}

test("a change of the population uploads only what has changed, after the first one", () => {
  const { gl, uploads } = createContext();
  const facts = factsOf(scene);
  const data = new SphereData(gl);
  data.setFacts(facts);
  const [from, to] = [state(1), state(2)];
  data.show({ from, to, mix: 0, moving: true }, eye);
  const change = (fields: object): void => {
    uploads.length = 0;
    data.updatePopulation(facts.population.apply(create(PopulationSchema, { epoch: 3, ...fields })));
  };
  change({ number: 1, removed: [{ first: 7, count: 2 }] });
  const whole = uploads.filter(([, count]) => count === places);
  assert.equal(whole.length, 3, "radii, ids and groups");
  change({ number: 2, removed: [{ first: 500, count: 3 }], added: [{ first: 7, count: 1, id: 1000n, group: 0 }] });
  const tables = [
    [7, 1],
    [7, 1],
    [7, 1],
    [500, 3],
    [500, 3],
    [500, 3],
  ]; // radii, ids and groups
  const looks = [[0, 3]];
  const values = [
    [7, 1],
    [500, 3],
    [7, 1],
    [500, 3],
  ]; // of both states
  assert.deepEqual(uploads, [...tables, ...looks, ...values]);
});

test("a table uploads the rows of a range in few parts", () => {
  const { gl, uploads } = createContext();
  const table = new Table(gl, 1);
  table.fit(10_000);
  table.upload(new Float32Array(10_000), { first: 2000, count: 7000 });
  assert.deepEqual(uploads, [
    [2000, 48],
    [2048, 6144],
    [8192, 808],
  ]);
});

test("a state that is shown again is not uploaded again", () => {
  const { gl, uploads } = createContext();
  const data = new SphereData(gl);
  data.setFacts(factsOf(scene));
  const [from, to] = [state(1), state(2)];
  data.show({ from, to, mix: 0, moving: true }, eye);
  uploads.length = 0;
  data.show({ from, to, mix: 0.5, moving: true }, eye);
  assert.deepEqual(uploads, []);
});

test("a state whose buffer has returned to the worker is not uploaded again", () => {
  const { gl, uploads } = createContext();
  const facts = factsOf(scene);
  const data = new SphereData(gl);
  data.setFacts(facts);
  const [gone, present] = [state(1), state(2)];
  data.show({ from: gone, to: present, mix: 0, moving: true }, eye);
  structuredClone(0, { transfer: [gone.columns.position.values.buffer] });
  uploads.length = 0;
  const change = create(PopulationSchema, { epoch: 3, number: 1, removed: [{ first: 4, count: 1 }] });
  data.updatePopulation(facts.population.apply(change));
  assert.deepEqual(uploads.filter(([first, count]) => first === 4 && count === 1).length, 1);
});
