// Tests the JSON Schema of `spherule scene schema` with a validator. SPHERULE: the program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
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
const emitter = (members) => ({ emitters: [{ box, rate: 10, radius: { constant: 0.1 }, ...members }] });
const field = (members) => ({ fields: [members] });
const buoyancy = (members) => field({ buoyancy: { density: 1000, ...members } });
const spring = (members) => field({ spring: { centre: [0, 0, 0], stiffness: 1, ...members } });
const vortex = (members) => field({ drag: { vortex: { centre: [0, 0, 0], axis: [0, 0, 1], core: 1, ...members } } });
const ball = { centre: [0, 0, 0], radius: 1 };
const cylinder = { from: [0, 0, 0], to: [0, 0, 1], radius: 1 };
const logNormal = (members) => radius({ logNormal: { median: 0.2, deviation: 0.5, min: 0.1, max: 0.4, ...members } });
const table = (members) => radius({ table: { radii: [0.1, 0.2], shares: [0, 1], ...members } });
const missing = undefined; // no member of the text

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
  "emitter without a region": emitter({ box: missing }),
  "emitter with two regions": emitter({ sphere: ball }),
  "emitter without a flow": emitter({ rate: missing }),
  "emitter with two flows": emitter({ massFlow: 1 }),
  "emitter without radius": emitter({ radius: missing }),
  "emitter that makes none": emitter({ rate: 0 }),
  "emitter that makes too many": emitter({ rate: 1e7 }),
  "rate as text": emitter({ rate: "many" }),
  "negative mass flow": emitter({ rate: missing, massFlow: -1 }),
  "misspelt spread": emitter({ velocitySpred: 1 }),
  "negative spread": emitter({ velocitySpread: -1 }),
  "flat velocity": emitter({ velocity: [0, 1] }),
  "spin as number": emitter({ spin: 1 }),
  "emitter of none": emitter({ total: 0 }),
  "half a sphere in all": emitter({ total: 1.5 }),
  "choked at once": emitter({ untilChoked: 0 }),
  "time of work without an end": emitter({ schedule: [{ from: 1 }] }),
  "time of work before the beginning": emitter({ schedule: [{ from: -1, to: 1 }] }),
  "time of work as number": emitter({ schedule: 1 }),
  "repeat as flag": emitter({ repeat: true }),
  "disc without a normal": emitter({ box: missing, disc: { centre: [0, 0, 0], radius: 1 } }),
  "seventeen emitters": { emitters: Array.from({ length: 17 }, () => emitter().emitters[0]) },
  "emitters as an object": { emitters: emitter().emitters[0] },
  "liquid of negative density": buoyancy({ density: -1 }),
  "liquid too dense": buoyancy({ density: 1e6 }),
  "surface as height": buoyancy({ surface: 0.5 }),
  "level of a liquid": buoyancy({ level: [0, 0, 0.5] }),
  "spring without centre": spring({ centre: missing }),
  "spring that pushes": spring({ stiffness: -1 }),
  "spring too stiff": spring({ stiffness: 1e10 }),
  "stiffness as text": spring({ stiffness: "1" }),
  "spring that adds energy": spring({ damping: -1 }),
  "misspelt stiffness": spring({ stifness: 1 }),
  "vortex without centre": vortex({ centre: missing }),
  "vortex without axis": vortex({ axis: missing }),
  "vortex without core": vortex({ core: missing }),
  "vortex with a core of zero": vortex({ core: 0 }),
  "vortex too fast": vortex({ speed: 1e6 }),
  "vortex with a radius": vortex({ radius: 1 }),
  "axis of a vortex by name": vortex({ axis: "Z" }),
  "vortex beside drag": field({ vortex: { centre: [0, 0, 0], axis: [0, 0, 1], core: 1 } }),
  "field with two regions": field({ drag: {}, inBox: box, inSphere: ball }),
  "region alone": field({ inBox: box }),
  "box of a field without max": field({ drag: {}, inBox: { min: [0, 0, 0] } }),
  "ball of a field without radius": field({ drag: {}, inSphere: { centre: [0, 0, 0] } }),
  "cylinder of a field of radius zero": field({ drag: {}, inCylinder: { ...cylinder, radius: 0 } }),
  "cylinder of a field without an end": field({ drag: {}, inCylinder: { ...cylinder, to: missing } }),
  "cone of a field": field({ drag: {}, inCone: cylinder }),
  "xyz without file": source({ xyz: {} }),
  "xyz with the file alone": source({ xyz: "a.xyz" }),
  "xyz of scale zero": source({ xyz: { file: "a.xyz", scale: 0 } }),
  "negative frame of xyz": source({ xyz: { file: "a.xyz", frame: -1 } }),
  "half a frame of xyz": source({ xyz: { file: "a.xyz", frame: 0.5 } }),
  "misspelt frame of xyz": source({ xyz: { file: "a.xyz", frames: 1 } }),
  "lammps without file": source({ lammps: { frame: 1 } }),
  "lammps of a file by number": source({ lammps: { file: 1 } }),
  "lammps of negative scale": source({ lammps: { file: "a.dump", scale: -1 } }),
  "frame of lammps by name": source({ lammps: { file: "a.dump", frame: "last" } }),
  "unit of lammps": source({ lammps: { file: "a.dump", units: "lj" } }),
  "lammps and xyz": source({ lammps: { file: "a.dump" }, xyz: { file: "a.xyz" } }),
  "log-normal without median": logNormal({ median: missing }),
  "log-normal without deviation": logNormal({ deviation: missing }),
  "log-normal without min": logNormal({ min: missing }),
  "log-normal without max": logNormal({ max: missing }),
  "log-normal of deviation zero": logNormal({ deviation: 0 }),
  "log-normal with a mean": logNormal({ mean: 0.2 }),
  "median as text": logNormal({ median: "0.2" }),
  "log-normal radius too large": logNormal({ max: 1e7 }),
  "misspelt log-normal": radius({ lognormal: { median: 0.2, deviation: 0.5, min: 0.1, max: 0.4 } }),
  "table without radii": table({ radii: missing }),
  "table without shares": table({ shares: missing }),
  "table of a radius of zero": table({ radii: [0, 0.2] }),
  "table of a share above one": table({ shares: [0, 1.1] }),
  "table of a negative share": table({ shares: [-0.1, 1] }),
  "table of one radius as number": table({ radii: 0.1 }),
  "table of 65 radii": table({ radii: Array.from({ length: 65 }, (_, k) => 0.1 + k) }),
  "table by mass as text": table({ byMass: "yes" }),
  "table by volume": table({ byVolume: true }),
  "table and constant": radius({ constant: 0.1, table: { radii: [0.1, 0.2], shares: [0, 1] } }),
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

test("every template of `spherule scene new` is valid", () => {
  const run = (...words) => execFileSync(process.env.SPHERULE, ["scene", "new", ...words], { encoding: "utf8" });
  const names = run()
    .trim()
    .split("\n")
    .map((line) => line.split(" ")[0]);
  assert.ok(names.length >= 4);
  const folder = mkdtempSync(path.join(tmpdir(), "spherule-schema-"));
  try {
    for (const name of names) {
      const file = path.join(folder, `${name}.json`);
      run(name, file);
      const scene = JSON.parse(readFileSync(file, "utf8"));
      assert.ok(validate(scene), `${name}: ${JSON.stringify(validate.errors)}`);
    }
  } finally {
    rmSync(folder, { recursive: true });
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
    emitter({}),
    emitter({ box: missing, disc: { centre: [0, 0, 0], normal: [0, 0, 1], radius: 1, hole: 0.5 } }),
    emitter({ rate: missing, massFlow: 1, schedule: [{ to: 1 }], repeat: 2, total: 5, untilChoked: 1 }),
    buoyancy({ surface: [0, 0, 0.5] }),
    spring({ damping: 0.5 }),
    vortex({ speed: -1 }),
    field({ drag: {}, inBox: box }),
    field({ drag: {}, inSphere: ball }),
    field({ drag: {}, inCylinder: cylinder }),
    source({ xyz: { file: "a.xyz", scale: 0.001, frame: 3 } }),
    source({ lammps: { file: "a.dump", scale: 0.001, frame: 3 } }),
    logNormal({}),
    table({ byMass: true }),
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
