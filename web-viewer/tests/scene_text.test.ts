import assert from "node:assert/strict";
import { test } from "node:test";
import { placeOf, readScene } from "../src/editor/scene_text";

const scene = `{
  "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]},
  "groups": [
    {
      "list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]},
      "radius": {"constant": 0.1},
      "fixed": true
    }
  ]
}`;

const lineOf = (text: string, from: number): number => text.slice(0, from).split("\n").length;

/** The line and the message of the first fault. */
function faultOf(text: string): [number, string] {
  const [first] = readScene(text).faults;
  return first ? [lineOf(text, first.from), first.message] : [0, ""];
}

test("a right scene is a message", () => {
  const { scene: read, faults } = readScene(scene);
  assert.deepEqual(faults, []);
  assert.deepEqual(read?.groups[0]?.radius?.kind, { case: "constant", value: 0.1 });
  assert.equal(readScene(scene.replace('"fixed"', '"sphere_contacts": true}, {"fixed"')).faults.length, 1);
});

test("a file may name the schema for editors", () => {
  const { scene: read, faults } = readScene(scene.replace('"bounds"', '"$schema": "scene.schema.json", "bounds"'));
  assert.deepEqual(faults, []);
  assert.equal(read?.groups.length, 1);
});

test("faults are at their lines", () => {
  const cases: [string, string, number, RegExp][] = [
    ['"fixed": true', '"fixed": true,', 8, /not JSON/],
    ['"radius": {', '"radius" {', 6, /not JSON/],
    ['"fixed"', '"fixd"', 7, /"fixd" is not known here. Known are name, list/],
    ['"constant": 0.1', '"constant": "wide"', 6, /constant: .*"wide"/],
    ['{"constant": 0.1}', "0.1", 6, /must be an object/],
    ["[0.5, 0.5, 0.5]", '[0.5, "x", 0.5]', 5, /position: .*"x"/],
    ['"list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]}', '"csv": {"file": "a.csv"}', 5, /as a list, or start/],
    ['"list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]}', '"xyz": {"file": "a.xyz"}', 5, /as a list, or start/],
    ['"list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]}', '"lammps": {"file": "a.dump"}', 5, /as a list, or start/],
  ];
  for (const [right, wrong, line, message] of cases) {
    const text = scene.replace(right, wrong);
    const [at, said] = faultOf(text);
    assert.equal(at, line, `${wrong}: ${said}`);
    assert.match(said, message);
  }
});

test("fields that the server refuses have a place in the text", () => {
  const cases: [string, number][] = [
    ["load.scene.groups[0].radius", 6],
    ["load.scene.groups[0].radius.constant", 6],
    ["load.scene.groups[0].list.spheres[0]", 5],
    ["load.scene.groups[0].colour", 4],
    ["load.scene.bounds.min", 2],
    ["load.scene.quality.substeps", 1],
    ["", 1],
  ];
  for (const [field, line] of cases) assert.equal(lineOf(scene, placeOf(scene, field).from), line, field);
});

test("scenes that do not fit into a message are not sent", () => {
  const spheres = Array.from({ length: 40_000 }, () => '{"position": [1, 2, 3]}').join(",");
  const [, message] = faultOf(scene.replace('{"position": [0.5, 0.5, 0.5]}', spheres));
  assert.match(message, /can load 1 MB: start the server/);
});
