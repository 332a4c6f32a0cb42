import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { PopulationSchema, SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { ColourRanges, highOf } from "../src/model/colour_ranges";
import { factsOf } from "../src/model/facts";
import type { Facts } from "../src/model/facts";
import { differences, joined, Population } from "../src/model/population";
import type { Run } from "../src/model/population";
import { positionOf } from "../src/model/positions";
import { quantityOf } from "../src/model/quantities";
import { Selection } from "../src/model/selection";
import type { State } from "../src/model/states";
import { createSession, positionsAt } from "./support/session";

const floats = (...values: number[]): Uint8Array => new Uint8Array(Float32Array.from(values).buffer);

/** Six places: two spheres of group 0 with ids 10 and 11, one of group 1 with id 4, and three places without. */
const facts = {
  epoch: 3,
  count: 6,
  radius: 0.5,
  groups: [{ name: "gas" }, { name: "dust" }],
  places: [
    { first: 1, count: 2, id: 10n, group: 0 },
    { first: 5, count: 1, id: 4n, group: 1 },
  ],
};

function populationOf(fields: MessageInitShape<typeof SceneFactsSchema> = {}): Population {
  return new Population(create(SceneFactsSchema, { ...facts, ...fields }));
}

function apply(to: Population, fields: MessageInitShape<typeof PopulationSchema>): Run[] {
  return to.apply(create(PopulationSchema, { number: to.number + 1, ...fields }));
}

const all = [0, 1, 2, 3, 4, 5];
const idsOf = (population: Population): (number | undefined)[] => all.map((place) => population.idOf(place));
const sizesOf = (population: Population): number[] => population.groups.map(({ count }) => count);

test("runs of places say which sphere is at each place", () => {
  const population = populationOf();
  assert.deepEqual(idsOf(population), [undefined, 10, 11, undefined, undefined, 4]);
  assert.deepEqual(
    all.map((place) => population.isUsed(place)),
    [false, true, true, false, false, true],
  );
  const groups = [undefined, "gas", "gas", undefined, undefined, "dust"];
  assert.deepEqual(
    all.map((place) => population.groupOf(place)?.name),
    groups,
  );
  assert.deepEqual(
    [4, 10, 11, 12].map((id) => population.placeOf(id)),
    [5, 1, 2, undefined],
  );
  assert.deepEqual([population.count, population.places, sizesOf(population)], [3, 6, [2, 1]]);
  assert.deepEqual(population.idRange, [4, 11]);
});

test("places without a sphere have radius 0, whether radii differ or not", () => {
  const equal = populationOf();
  assert.deepEqual([...(equal.radii ?? [])], [0, 0.5, 0.5, 0, 0, 0.5]);
  assert.deepEqual(equal.radiusRange, [0.5, 0.5]);
  const different = populationOf({ radius: 0, radii: floats(9, 1, 0.25, 9, 9, 0.75) });
  assert.deepEqual([...(different.radii ?? [])], [0, 1, 0.25, 0, 0, 0.75]);
  assert.deepEqual(different.radiusRange, [0.25, 1]);
});

test("the mean radius is of the spheres that can move, or of all if none can", () => {
  assert.equal(populationOf().meanRadius, 0.5);
  const radii = { radius: 0, radii: floats(9, 1, 0.25, 9, 9, 0.75) };
  assert.equal(populationOf(radii).meanRadius, (1 + 0.25 + 0.75) / 3);
  assert.equal(populationOf({ ...radii, groups: [{ fixed: true }, {}] }).meanRadius, 0.75);
  assert.equal(populationOf({ ...radii, groups: [{ fixed: true }, { fixed: true }] }).meanRadius, 2 / 3);
  assert.equal(populationOf({ ...radii, places: [], count: 0, radii: floats() }).meanRadius, 0);
});

test("without places, all are in use and ids are places, as older servers have it", () => {
  const groups = [
    { name: "a", first: 0, count: 2 },
    { name: "b", first: 2, count: 4 },
  ];
  const population = populationOf({ places: [], groups });
  assert.deepEqual(idsOf(population), all);
  assert.deepEqual([population.ids, population.radii, population.count], [undefined, undefined, 6]);
  assert.deepEqual([population.radiusOf(3), population.idRange, sizesOf(population)], [0.5, [0, 5], [2, 4]]);
  assert.deepEqual([population.groupOf(1)?.name, population.groupOf(2)?.name], ["a", "b"]);
  assert.deepEqual([population.placeOf(5), population.placeOf(6)], [5, undefined]);
});

test("an empty run says that no place is in use", () => {
  const population = populationOf({ places: [{ first: 0, count: 0, id: 0n, group: 0 }] });
  assert.deepEqual([population.count, idsOf(population).some((id) => id !== undefined)], [0, false]);
  assert.deepEqual([population.idRange, populationOf({ count: 0, places: [] }).count], [[0, 0], 0]);
});

test("a change removes spheres, then adds others", () => {
  const population = populationOf({ radius: 0, radii: floats(0, 1, 0.25, 0, 0, 0.75) });
  const changed = apply(population, {
    removed: [{ first: 1, count: 1 }],
    groups: [{ name: "rain" }],
    added: [{ first: 0, count: 2, id: 5_000_000_000n, group: 2, radii: floats(0.5, 2) }],
  });
  assert.deepEqual(changed, [
    { first: 1, count: 1 },
    { first: 0, count: 2 },
  ]);
  assert.deepEqual(idsOf(population), [5_000_000_000, 5_000_000_001, 11, undefined, undefined, 4]);
  assert.deepEqual([...(population.radii ?? [])], [0.5, 2, 0.25, 0, 0, 0.75]);
  assert.deepEqual([population.groupOf(1)?.name, sizesOf(population)], ["rain", [1, 1, 2]]);
  assert.deepEqual([population.count, population.number], [4, 1]);
});

test("ranges follow the spheres that exist", () => {
  const population = populationOf({ radius: 0, radii: floats(0, 1, 0.25, 0, 0, 0.75) });
  assert.deepEqual(
    [population.radiusRange, population.idRange],
    [
      [0.25, 1],
      [4, 11],
    ],
  );
  apply(population, {
    removed: [
      { first: 1, count: 1 },
      { first: 5, count: 1 },
    ],
  });
  assert.deepEqual(
    [population.radiusRange, population.idRange],
    [
      [0.25, 0.25],
      [11, 11],
    ],
  );
  apply(population, { added: [{ first: 3, count: 1, id: 20n, group: 0, radii: floats(3) }] });
  assert.deepEqual(
    [population.radiusRange, population.idRange],
    [
      [0.25, 3],
      [11, 20],
    ],
  );
  const ranges = new ColourRanges();
  const scene = factsOf(create(SceneFactsSchema, facts));
  assert.deepEqual(
    [ranges.of("id", scene), ranges.of("radius", scene)],
    [
      [4, 11],
      [0.5, 0.5],
    ],
  );
});

test("the first change of a scene whose places were all in use makes its tables", () => {
  const population = populationOf({ places: [], groups: [{ name: "a", first: 0, count: 6 }] });
  apply(population, { removed: [{ first: 2, count: 2 }], added: [{ first: 3, count: 1, id: 6n, group: 0 }] });
  assert.deepEqual(idsOf(population), [0, 1, undefined, 6, 4, 5]);
  assert.deepEqual([...(population.radii ?? [])], [0.5, 0.5, 0, 0.5, 0.5, 0.5]);
  assert.deepEqual([population.count, sizesOf(population), population.idRange], [5, [5], [0, 6]]);
});

test("places beyond the last one are ignored", () => {
  const population = populationOf({ places: [{ first: 4, count: 9, id: 1n, group: 0 }] });
  assert.deepEqual([population.count, population.radii?.length], [2, 6]);
  const removed = [
    { first: 5, count: 7 },
    { first: 4_000_000_000, count: 4_000_000_000 },
  ];
  assert.deepEqual(apply(population, { removed }), [{ first: 5, count: 1 }]);
  assert.equal(population.count, 1);
});

test("runs are joined to few uploads, and two populations are compared by their spheres", () => {
  const runs = [
    { first: 90, count: 2 },
    { first: 0, count: 5 },
    { first: 8, count: 1 },
    { first: 3, count: 1 },
  ];
  assert.deepEqual(joined(runs, 3), [
    { first: 0, count: 9 },
    { first: 90, count: 2 },
  ]);
  assert.deepEqual(joined(runs, 2), [
    { first: 0, count: 5 },
    { first: 8, count: 1 },
    { first: 90, count: 2 },
  ]);
  const places = [
    { first: 1, count: 1, id: 10n, group: 0 },
    { first: 4, count: 2, id: 30n, group: 1 },
  ];
  assert.deepEqual(differences(populationOf(), populationOf({ places })), [
    { first: 2, count: 1 },
    { first: 4, count: 2 }, // place 5 has another sphere
  ]);
});

test("places without a sphere are not measured, and the legend counts spheres", () => {
  const scene = factsOf(create(SceneFactsSchema, { ...facts, boundsMin: [-9, -9, -9], boundsMax: [9, 9, 9] }));
  const isUsed = (place: number): boolean => scene.population.isUsed(place);
  assert.equal(
    highOf((place) => (isUsed(place) ? 7 - place : 1000), 6, isUsed),
    5,
  );
  assert.equal(
    highOf(
      () => 1000,
      6,
      () => false,
    ),
    undefined,
  );
  assert.equal(
    highOf(
      (place) => place,
      5000,
      (place) => place === 1234,
    ),
    1234,
    "one sphere between two samples",
  );
  const legend = quantityOf("group").legend(scene, [0, 1]);
  assert.deepEqual("swatches" in legend && legend.swatches.map(({ figure }) => figure), ["2", "1"]);
});

test("automatic colour ranges ignore places without a sphere", () => {
  const scene = factsOf(create(SceneFactsSchema, facts));
  const at = (simTime: number, xs: number[]): State => {
    const position = positionsAt(xs.flatMap((x) => [x, 0, 0]));
    const drawing = { order: 1, boxes: new Float64Array(0), poses: [] };
    return { sequence: 1, epoch: 3, step: 1, simTime, count: 6, columns: { position }, ...drawing };
  };
  const ranges = new ColourRanges();
  const shown = { from: at(0, [0, 0, 0, 0, 0, 0]), to: at(1, [90, 2, 2, 90, 90, 2]), mix: 1, moving: false };
  ranges.update("speed", scene, shown, 0);
  assert.deepEqual(ranges.of("speed", scene), [0, 2]);
});

test("a change is applied with the first frame that includes it, however many frames come before", () => {
  const { session, changes, population, scene, frame } = createSession();
  scene(facts);
  frame(0, all);
  population(1, { removed: [{ first: 1, count: 1 }] });
  population(2, { removed: [{ first: 2, count: 1 }] });
  frame(0, all);
  assert.deepEqual([session.facts?.population.count, session.facts?.population.number, changes.length], [3, 0, 0]);
  frame(1, all);
  assert.deepEqual([session.facts?.population.count, session.facts?.population.number], [2, 1]);
  population(3, { added: [{ first: 1, count: 1, id: 30n, group: 0 }] });
  frame(3, all);
  assert.deepEqual([session.facts?.population.count, session.facts?.population.placeOf(30)], [2, 1]);
  assert.deepEqual(changes, [
    [{ first: 1, count: 1 }],
    [
      { first: 2, count: 1 },
      { first: 1, count: 1 },
    ],
  ]);
  assert.equal(session.frames, 4);
});

test("frames of a population that the page does not know, or no longer has, are ignored", () => {
  const { session, dropped, population, scene, frame } = createSession();
  scene({ ...facts, population: 4 });
  frame(5, all);
  frame(3, all);
  assert.deepEqual([session.frames, dropped.length, session.newest], [0, 2, undefined]);
  frame(4, all);
  population(5);
  frame(5, all);
  assert.deepEqual([session.frames, session.newest?.sequence], [2, 4]);
});

test("known changes and those of another epoch are ignored, a gap is an error", () => {
  const { session, faults, population, scene, frame } = createSession();
  scene({ ...facts, population: 4 });
  population(4, { removed: [{ first: 1, count: 1 }] });
  population(5, { epoch: 2, removed: [{ first: 1, count: 1 }] });
  population(5, { removed: [{ first: 2, count: 1 }] });
  population(5, { removed: [{ first: 1, count: 1 }] });
  assert.deepEqual(faults, []);
  population(7, { removed: [{ first: 5, count: 1 }] });
  assert.deepEqual(faults, ["population: change 7 does not follow change 5"]);
  frame(5, all);
  assert.deepEqual(session.facts && idsOf(session.facts.population).filter((id) => id !== undefined), [10, 4]);
});

test("facts of the same epoch replace the tables with the first frame that includes them", () => {
  const { session, changes, population, scenes, scene, frame } = createSession();
  scene(facts);
  frame(0, all);
  population(1, { removed: [{ first: 5, count: 1 }] });
  population(2, { removed: [{ first: 1, count: 2 }] });
  scene({ ...facts, population: 4, places: [{ first: 2, count: 2, id: 11n, group: 0 }] });
  population(5, { added: [{ first: 0, count: 1, id: 40n, group: 1 }] });
  frame(0, all);
  assert.deepEqual(session.facts && idsOf(session.facts.population), [undefined, 10, 11, undefined, undefined, 4]);
  frame(4, all);
  assert.deepEqual(
    [2, 3].map((place) => session.facts?.population.idOf(place)),
    [11, 12],
  );
  assert.deepEqual([session.facts?.population.number, session.facts?.population.count], [4, 2]);
  assert.deepEqual(changes, [
    [
      { first: 1, count: 1 },
      { first: 3, count: 1 },
      { first: 5, count: 1 },
    ],
  ]);
  frame(5, all);
  assert.deepEqual([session.facts?.population.placeOf(40), session.facts?.population.count], [0, 3]);
  assert.deepEqual([scenes(), session.frames], [1, 4]);
});

test("another epoch forgets pending changes", () => {
  const { session, changes, population, scene, frame } = createSession();
  scene(facts);
  population(1, { removed: [{ first: 1, count: 1 }] });
  scene({ ...facts, epoch: 4 });
  frame(0, all, 4);
  frame(1, all, 4);
  assert.deepEqual([session.facts?.population.count, changes.length, session.frames], [3, 0, 1]);
});

test("a new sphere does not fly from the position of another, and a removed one is gone at once", () => {
  const { session, population, scene, frame } = createSession();
  scene(facts);
  frame(0, [9, 1, 2, 9, 9, 5]);
  frame(0, [9, 1.5, 2.5, 9, 9, 5.5]);
  const [earliest, latest] = [session.states.shown(0)?.from, session.states.shown(1e9)?.to];
  population(1, {
    removed: [{ first: 1, count: 1 }],
    added: [
      { first: 1, count: 1, id: 50n, group: 0 },
      { first: 3, count: 2, id: 51n, group: 0 },
    ],
  });
  frame(1, [9, -1, 3, -3, -4, 6]);
  const xs = (state: State | undefined): number[] =>
    [0, 1, 2, 3, 4, 5].map((place) => positionOf(session.facts as Facts, state as State, place)[0]);
  assert.deepEqual(xs(earliest), [9, -1, 2, -3, -4, 5]);
  assert.deepEqual(xs(latest), [9, -1, 2.5, -3, -4, 5.5]);
  assert.equal(session.states.newest?.sequence, 3);
  assert.equal(session.facts?.population.placeOf(10), undefined);
});

test("a new sphere keeps its position in states of another tier", () => {
  const { session, population, scene, frame } = createSession();
  scene(facts);
  frame(0, [0, 1, 2, 0, 0, 5], 3, 0.25);
  const earlier = session.states.newest;
  population(1, { added: [{ first: 3, count: 1, id: 50n, group: 0 }] });
  frame(1, [0, 1, 2, -3.375, 0, 5], 3, 0.125);
  assert.deepEqual([...(earlier?.columns.position.values ?? [])].slice(6, 12), [8, 0, 0, -13, 0, 0]); // quarters
});

test("an older server, without places and numbers, is followed as before", () => {
  const { session, changes, dropped, faults, scene, frame } = createSession();
  scene({ count: 2, groups: [{ name: "a", first: 0, count: 2 }] });
  frame(0, [0, 1]);
  scene({ epoch: 4, count: 3, groups: [{ name: "a", first: 0, count: 3 }] });
  frame(0, [0, 1]);
  frame(0, [0, 1, 2], 4);
  assert.deepEqual([session.frames, session.facts?.population.count, dropped.length], [2, 3, 2]);
  assert.deepEqual([changes, faults], [[], []]);
});

test("the selection follows a sphere, and ends with it", () => {
  const population = populationOf();
  const selection = new Selection();
  selection.select(population, 3);
  assert.deepEqual([selection.id, selection.place], [undefined, undefined], "no sphere is there");
  selection.select(population, 2);
  apply(population, { removed: [{ first: 1, count: 1 }] });
  selection.follow(population);
  assert.deepEqual([selection.id, selection.place], [11, 2]);
  selection.follow(populationOf({ epoch: 4, places: [{ first: 0, count: 2, id: 10n, group: 0 }] }));
  assert.deepEqual([selection.id, selection.place], [11, 1], "at another place in another epoch");
  selection.select(population, 2);
  const reused = { removed: [{ first: 2, count: 1 }], added: [{ first: 2, count: 1, id: 60n, group: 0 }] };
  apply(population, reused);
  selection.follow(population);
  assert.deepEqual([selection.id, selection.place], [undefined, undefined], "another sphere is at its place");
});
