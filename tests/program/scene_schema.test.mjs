// Tests the JSON Schema of `spherule scene schema` with a validator. SPHERULE: the program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const { default: Ajv2020 } = createRequire(path.join(here, "../browser/package.json"))("ajv/dist/2020");
const schema = JSON.parse(execFileSync(process.env.SPHERULE, ["scene", "schema"], { encoding: "utf8" }));
const validate = new Ajv2020({ allErrors: true, strict: true, strictRequired: false }).compile(schema);
const bounds = { min: [0, 0, 0], max: [1, 1, 1] };

const group = (members) => ({ groups: [{ list: {}, ...members }] });
const source = (members) => ({ groups: [members] });
const radius = (members) => group({ radius: members });
const obstacle = (members) => ({ obstacles: [members] });
const box = { min: [0, 0, 0], max: [1, 1, 1] };
const moving = (members) => obstacle({ box, motion: members });
const driven = (members) => moving({ drive: { along: [0, 0, 1], mostSpeed: 1, ...members } });

const wrong = {
  "no bounds": { bounds: undefined },
  "unknown field": { gravitation: [0, 0, 1] },
  "name as in scene.proto": { contact_sums: true },
  "short vector": { gravity: [0, 0] },
  "long vector": { gravity: [0, 0, 0, 0] },
  "component out of range": { gravity: [0, 0, 2e9] },
  "text in a vector": { gravity: [0, 0, "1"] },
  "step out of range": { step: 2 },
  "step of zero": { step: 0 },
  "number as text": { step: "0.1" },
  "flag as number": { sphereContacts: 1 },
  "long name": { name: "n".repeat(201) },
  "nine fields": { fields: Array.from({ length: 9 }, () => ({ drag: {} })) },
  "field without a kind": { fields: [{}] },
  "field with two kinds": { fields: [{ drag: {}, attraction: { centre: [0, 0, 0], softening: 1 } }] },
  "negative density": { fields: [{ drag: { density: -1 } }] },
  "attraction without softening": { fields: [{ attraction: { centre: [0, 0, 0] } }] },
  "restitution above one": { materials: [{ restitution: 1.1 }] },
  "friction as text": { materials: [{ friction: "high" }] },
  "pair of one": { pairs: [{ a: "a" }] },
  "unknown model": { quality: { model: "EXACT" } },
  "model by number": { quality: { model: 1 } },
  "half a substep": { quality: { substeps: 1.5 } },
  "two goals": { quality: { auto: { budgetMs: 1, overlap: 0.1 } } },
  "goal of zero": { quality: { auto: { budgetMs: 0 } } },
  "bounds without max": { bounds: { min: [0, 0, 0] } },
  "unknown face": { bounds: { ...bounds, open: ["TOP"] } },
  "unspecified face": { bounds: { ...bounds, open: ["FACE_UNSPECIFIED"] } },
  "periodic face": { bounds: { ...bounds, periodic: ["X_MIN"] } },
  "obstacle without a shape": obstacle({ colour: "#123456" }),
  "obstacle with two shapes": obstacle({ box, plane: { point: [0, 0, 0], normal: [0, 0, 1] } }),
  "colour by name": obstacle({ box, colour: "red" }),
  "sphere without radius": obstacle({ sphere: { centre: [0, 0, 0] } }),
  "cylinder of radius zero": obstacle({ cylinder: { from: [0, 0, 0], to: [0, 0, 1], radius: 0 } }),
  "rotation without axis": obstacle({ box, rotation: { degrees: 3 } }),
  "mesh with negative scale": obstacle({ mesh: { file: "a.stl", scale: -1 } }),
  "one column of heights": obstacle({ heightField: { ...box, heights: [1], columns: 1 } }),
  "five oscillations": moving({ oscillations: Array.from({ length: 5 }, () => ({ frequency: 1 })) }),
  "keyframe without time": moving({ keyframes: [{ translation: [0, 0, 1] }] }),
  "negative duration": moving({ duration: -1 }),
  "drive without speed": moving({ drive: { along: [0, 0, 1] } }),
  "negative damping": driven({ damping: -1 }),
  "group without a source": source({ name: "a" }),
  "group with two sources": source({ list: {}, csv: { file: "a.csv" } }),
  "csv without file": source({ csv: {} }),
  "fill of none": source({ fill: { ...box, count: 0 } }),
  "lattice without spacing": source({ lattice: box }),
  "negative seed": source({ lattice: { ...box, spacing: 1, seed: -1 } }),
  "seed in words": source({ lattice: { ...box, spacing: 1, seed: "one" } }),
  "radius as number": group({ radius: 0.1 }),
  "radius of no kind": radius({}),
  "radius too large": radius({ constant: 1e7 }),
  "uniform without max": radius({ uniform: { min: 0.1 } }),
  "misspelt constant": radius({ constnat: 0.1 }),
  "roughness above one": group({ roughness: 1.5 }),
  "sphere without position": source({ list: { spheres: [{ radius: 1 }] } }),
  "field of view of zero": { camera: { fieldOfView: 0 } },
  "light too strong": { light: { strength: 11 } },
  "sleep without time": { sleep: { time: 0 } },
  "sink without region": { sinks: [{}] },
};

test("every scene of the program is valid", () => {
  const folder = path.join(here, "../../server/scenes");
  const files = readdirSync(folder).filter((name) => name.endsWith(".json"));
  assert.ok(files.length > 20);
  for (const file of files) {
    const scene = JSON.parse(readFileSync(path.join(folder, file), "utf8"));
    assert.ok(validate(scene), `${file}: ${JSON.stringify(validate.errors)}`);
  }
});

test("the example of the page on scenes is valid", () => {
  const page = readFileSync(path.join(here, "../../docs/scene-format.md"), "utf8");
  const example = JSON.parse(page.match(/```json\n(.*?)```/s)[1]);
  assert.ok(validate(example), JSON.stringify(validate.errors));
});

test("right values are valid", () => {
  for (const members of [
    { $schema: "scene.schema.json" },
    { quality: { auto: {} } },
    source({ fill: { ...box, count: 1, seed: "18446744073709551615" } }),
    source({ fill: { ...box, count: 1, seed: 7 } }),
    driven({ mass: 1 }),
  ])
    assert.ok(validate({ bounds, ...members }), JSON.stringify([members, validate.errors]));
});

for (const [name, members] of Object.entries(wrong))
  test(`a scene is invalid: ${name}`, () => {
    const scene = JSON.parse(JSON.stringify({ bounds, ...members }));
    assert.equal(validate(scene), false);
  });

test("each field has a description", () => {
  for (const [name, message] of Object.entries(schema.$defs))
    for (const [field, one] of Object.entries(message.properties)) assert.ok(one.description, `${name}.${field}`);
});
