import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { materialColour } from "../src/colour/palette";
import { heightRamp, radiusRamp, speedRamp } from "../src/colour/ramp";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { Quantity } from "../src/gen/spherule/v1/frame_pb";
import { ColourRanges } from "../src/model/colour_ranges";
import { factsOf } from "../src/model/facts";
import type { Facts } from "../src/model/facts";
import { modes, quantityOf } from "../src/model/quantities";
import type { LegendContent, Mode } from "../src/model/quantities";
import type { State } from "../src/model/states";
import { positionsAt } from "./support/session";

const groups = Array.from({ length: 8 }, (_, k) => ({ name: `g${k}`, first: k, count: 1 }));

function facts(fields = {}): Facts {
  return factsOf(create(SceneFactsSchema, { epoch: 1, count: 8, radius: 0.25, groups, ...fields }));
}

function legendOf(mode: Mode, of: Facts): LegendContent {
  return quantityOf(mode).legend(of, new ColourRanges().of(mode, of));
}

function state(sequence: number, simTime: number, x: number): State {
  const position = positionsAt([x, 0, 0]);
  const drawing = { order: 1, boxes: new Float64Array(0), poses: [] };
  return { sequence, epoch: 1, step: sequence, simTime, count: 1, columns: { position }, ...drawing };
}

test("the ranges of what changes with time are automatic", () => {
  const ranges = new ColourRanges();
  const automatic = modes.filter((mode) => ranges.isAutomatic(mode));
  assert.deepEqual(automatic, ["speed", "contacts", "overlap", "energy", "height"]);
  assert.deepEqual(ranges.of("speed", undefined), [0, 0.1]);
  assert.deepEqual(ranges.of("id", facts()), [0, 7]);
});

test("automatic ranges follow the values shown, unless they are locked", () => {
  const ranges = new ColourRanges();
  const shown = { from: state(1, 0, 0), to: state(2, 0.5, 2), mix: 1, moving: false };
  ranges.toggleLock();
  ranges.update("speed", facts(), shown, 0);
  assert.deepEqual([ranges.locked, ranges.of("speed", undefined)], [true, [0, 0.1]]);
  ranges.toggleLock();
  ranges.update("speed", facts(), { ...shown, to: state(3, 0.5, 2) }, 250);
  assert.deepEqual([ranges.locked, ranges.of("speed", undefined)], [false, [0, 5]]);
  ranges.reset();
  assert.deepEqual(ranges.of("speed", undefined), [0, 0.1]);
});

test("ends that the user gives replace the automatic ones until another scene comes", () => {
  const ranges = new ColourRanges();
  ranges.give("speed", { low: 0.02 });
  assert.deepEqual(ranges.of("speed", undefined), [0.02, 0.1]);
  ranges.give("radius", { high: 7 });
  assert.deepEqual(ranges.of("radius", facts()), [0.25, 7]);
  assert.deepEqual(ranges.automaticOf("radius", facts()), [0.25, 0.25]);
  ranges.give("radius", {});
  assert.deepEqual(ranges.of("radius", facts()), [0.25, 0.25]);
  ranges.reset();
  assert.deepEqual(ranges.of("speed", undefined), [0, 0.1]);
});

test("each mode with a quantity of the server asks for it, and its legend has the unit", () => {
  const asked = modes.flatMap((mode) => quantityOf(mode).sent ?? []);
  assert.deepEqual(asked, [Quantity.SPEED, Quantity.CONTACTS, Quantity.OVERLAP, Quantity.ENERGY]);
  const ends = (mode: Mode, high: number): string[] => {
    const legend = quantityOf(mode).legend(facts(), [0, high]);
    return "bar" in legend ? [legend.low, legend.high] : [];
  };
  assert.deepEqual(ends("contacts", 12), ["0", "12 bodies"]);
  assert.deepEqual(ends("overlap", 0.05), ["0 %", "5 % of the radius"]);
  assert.deepEqual(ends("energy", 0.002), ["0 J", "2 mJ"]);
});

test("heights are those of the image, above the lower face of the bounds", () => {
  const at = (sequence: number, z: number): State => {
    const position = positionsAt([3, 4, z]);
    return { ...state(sequence, sequence, 0), columns: { position } };
  };
  const { scale } = quantityOf("height");
  const bounded = facts({ boundsMin: [-1, -1, 10], boundsMax: [1, 1, 16] }); // positions are relative to z = 13
  const shown = { from: at(1, -3), to: at(2, -1), mix: 0.25, moving: true };
  assert.ok(scale && "value" in scale);
  assert.equal(scale.value(bounded, shown, 0), 0.5);
  assert.ok(Number.isNaN(scale.value(bounded, shown, 1)), "no sphere");
  assert.deepEqual(quantityOf("height").legend(bounded, [0, 0.5]), { bar: heightRamp, low: "0 m", high: "50 cm" });
});

test("a speed is shown with what is known of it", () => {
  const text = (from: State, to: State): string | undefined =>
    quantityOf("speed").describe?.(facts(), { from, to, mix: 1, moving: false }, 0);
  assert.equal(text(state(1, 0, 0), state(2, 1, 4)), "4 m/s");
  assert.equal(text(state(1, 0, 0), state(2, 1, 0.1)), "0.0827 to 0.117 m/s");
  assert.equal(text(state(1, 0, 0), state(2, 1, 0.01)), "under 0.0273 m/s");
  assert.equal(text(state(1, 0, 0), state(2, 0, 0)), "speed unknown");
});

test("a legend has a bar with its ends, or swatches and notes", () => {
  assert.deepEqual(legendOf("speed", facts()), { bar: speedRamp, low: "0", high: "0.1 m/s" });
  const one = { colour: radiusRamp[0], name: "all 25 cm", figure: "" };
  assert.deepEqual(legendOf("radius", facts()), { swatches: [one], notes: [] });
  const radii = new Uint8Array(new Float32Array([0.5, 0.25]).buffer);
  const range = { bar: radiusRamp, low: "25 cm", high: "50 cm" };
  assert.deepEqual(legendOf("radius", facts({ radius: 0, count: 2, radii })), range);
  assert.deepEqual(legendOf("cell", facts()), { swatches: [], notes: ["this scene has no grid"] });
});

test("the legend of materials names the materials of groups, with their spheres", () => {
  const some = facts({
    materials: ["steel", "", "wall", "glass"],
    groups: [
      { name: "a", first: 0, count: 3, material: 3 },
      { name: "b", first: 3, count: 4, material: 0 },
      { name: "c", first: 7, count: 1, material: 3 },
      { name: "d", first: 8, count: 0, material: 1 },
    ],
  });
  const swatches = (of: Facts): string[] => {
    const legend = legendOf("material", of);
    return "swatches" in legend
      ? [...legend.swatches.map(({ name, figure }) => `${name} ${figure}`), ...legend.notes]
      : [];
  };
  assert.deepEqual(swatches(some), ["steel 4", "material 2 0", "glass 4"]);
  const colours = some.population.materials.map(({ colour }) => colour);
  assert.deepEqual(colours, [0, 1, 3].map(materialColour));
  assert.deepEqual(swatches(facts()), ["no spheres whose material is known"], "the server is older");
});

test("the legend of groups lists six of them, and counts the others", () => {
  const legend = legendOf("group", facts());
  assert.ok("swatches" in legend);
  assert.deepEqual(
    legend.swatches.map(({ name }) => name),
    ["g0", "g1", "g2", "g3", "g4", "g5"],
  );
  assert.deepEqual(legend.notes, ["and 2 more"]);
});
