import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { PopulationSchema, SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { factsOf } from "../src/model/facts";
import type { State } from "../src/model/states";
import { SphereData } from "../src/renderer/spheres";

const places = 1000;
const groups = [{ name: "a", count: places }];
const scene = create(SceneFactsSchema, { epoch: 3, count: places, radius: 0.5, groups });

/** A WebGL context that does nothing but keep the uploads: of a whole buffer, or of a part from a byte on. */
function createContext() {
  const uploads: { at: number | undefined; bytes: number }[] = [];
  const calls: Record<string, unknown> = {
    createBuffer: () => ({}),
    bufferData: (_: number, data: ArrayBufferView) => void uploads.push({ at: undefined, bytes: data.byteLength }),
    bufferSubData: (_: number, at: number, data: ArrayBufferView) => void uploads.push({ at, bytes: data.byteLength }),
  };
  const gl = new Proxy(calls, { get: (target, name: string) => target[name] ?? (() => undefined) });
  return { gl: gl as unknown as WebGL2RenderingContext, uploads };
}

function state(sequence: number): State {
  const position = { values: new Float32Array(3 * places), quantum: 0.01 };
  return { sequence, epoch: 3, step: sequence, simTime: sequence, count: places, columns: { position } };
}

test("a change of the population uploads only what has changed, after the first one", () => {
  const { gl, uploads } = createContext();
  const facts = factsOf(scene);
  const data = new SphereData(gl);
  data.setFacts(facts);
  const [from, to] = [state(1), state(2)];
  data.show({ from, to, mix: 0, moving: true });
  const change = (fields: object): void => {
    uploads.length = 0;
    data.updatePopulation(facts.population.apply(create(PopulationSchema, { epoch: 3, ...fields })));
  };
  change({ number: 1, removed: [{ first: 7, count: 2 }] });
  const whole = uploads.filter(({ at }) => at === undefined).map(({ bytes }) => bytes);
  assert.deepEqual(whole, [4 * places, 4 * places, 4 * places], "radii, ids and colours");
  change({ number: 2, removed: [{ first: 500, count: 3 }], added: [{ first: 7, count: 1, id: 1000n, group: 0 }] });
  const tables = [28, 28, 28, 2000, 2000, 2000]; // the first bytes of radii, ids and colours
  const values = [84, 6000, 84, 6000]; // of both states
  assert.deepEqual(uploads.map(({ at }) => at), [...tables, ...values]);
  assert.deepEqual(uploads.map(({ bytes }) => bytes), [4, 4, 4, 12, 12, 12, 12, 36, 12, 36]);
});

test("a state whose buffer has returned to the worker is not uploaded again", () => {
  const { gl, uploads } = createContext();
  const facts = factsOf(scene);
  const data = new SphereData(gl);
  data.setFacts(facts);
  const [gone, present] = [state(1), state(2)];
  data.show({ from: gone, to: present, mix: 0, moving: true });
  structuredClone(0, { transfer: [gone.columns.position.values.buffer] });
  uploads.length = 0;
  const change = create(PopulationSchema, { epoch: 3, number: 1, removed: [{ first: 4, count: 1 }] });
  data.updatePopulation(facts.population.apply(change));
  assert.deepEqual(uploads.filter(({ at }) => at !== undefined), [{ at: 48, bytes: 12 }]);
});
