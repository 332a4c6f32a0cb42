import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { chartKinds } from "../src/charts/chart_list";
import { DiagnosticsSchema, StatisticsSchema } from "../src/gen/spherule/v1/diagnostics_pb";
import type { Diagnostics } from "../src/gen/spherule/v1/diagnostics_pb";
import { Samples } from "../src/model/samples";

function at(step: number, fields = {}): Diagnostics {
  return create(DiagnosticsSchema, { statistics: { step: BigInt(step), simTime: step / 60, ...fields } });
}

const stepsOf = (samples: Samples): number[] => samples.list.map(({ statistics }) => Number(statistics.step));

test("samples are bounded, and a paused world adds none", () => {
  const samples = new Samples();
  for (let step = 1; step <= 1000; step++) samples.add(at(step));
  assert.deepEqual([samples.list.length, stepsOf(samples)[0], stepsOf(samples).at(-1)], [900, 101, 1000]);
  const { version } = samples;
  samples.add(at(1000));
  assert.deepEqual([samples.list.length, samples.version], [900, version]);
});

test("a new run begins without samples", () => {
  const samples = new Samples();
  for (const step of [60, 120, 180, 0, 60]) samples.add(at(step));
  assert.deepEqual(stepsOf(samples), [0, 60]);
  const { version } = samples;
  samples.clear();
  assert.deepEqual(stepsOf(samples), []);
  assert.ok(samples.version > version);
});

test("charts show the figures with their units, and gaps where they are unknown", () => {
  const energies = { kineticEnergy: 1, rotationalEnergy: 2, potentialEnergy: 4, elasticEnergy: 8 };
  const surfaceForces = [{ surface: "Z_MIN", force: [0, 3, -4] }];
  const more = { momentum: [1, 2, 3], angularMomentum: [4, 5, 6], overlapMean: 0.001, overlapMax: 0.02 };
  const statistics = create(StatisticsSchema, { ...energies, ...more, surfaceForces });
  const sample = { statistics, realTimeFactor: 0.5, delay: NaN };
  const shown = chartKinds.map(({ name, series, text }) => {
    const values = series(sample).map((one) => `${one.name} ${text(one.value(sample))}`);
    return `${name}: ${values.join(", ")}`;
  });
  assert.deepEqual(shown, [
    "Energies: kinetic 1 J, rotational 2 J, potential 4 J, elastic 8 J, total 15 J",
    "Momentum: x 1 N s, y 2 N s, z 3 N s",
    "Angular momentum: x 4 N m s, y 5 N m s, z 6 N m s",
    "Overlap: mean 0.1 %, largest 2 %",
    "Forces on walls: Z_MIN 5 N",
    "Real-time factor: factor 0.5 ×",
    "Frame delay: delay – ms",
  ]);
  const without = { ...sample, statistics: create(StatisticsSchema) };
  assert.deepEqual(chartKinds[4]?.series(without), [], "a scene without contact sums has no forces");
  assert.deepEqual(
    chartKinds[4].series(sample).map((one) => one.value(without)),
    [NaN],
  );
});
