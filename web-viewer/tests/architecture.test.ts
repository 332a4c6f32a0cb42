import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";

// Tests run in web-viewer/.

/** Which modules each module may import. A module is a folder of src/, or a file that lies in src/ itself. */
const allowed: Record<string, string[]> = {
  gen: [],
  clock: [],
  ticker: [],
  columns: ["codec", "gen"],
  format: [],
  observed: [],
  perf_marks: ["clock"],
  codec: [],
  connection: ["clock", "codec", "columns", "format", "gen"],
  archive: ["codec", "connection", "gen"],
  colour: ["gen"],
  model: ["clock", "colour", "columns", "connection", "format", "gen", "observed", "perf_marks"],
  camera: ["model"],
  charts: ["format", "gen", "model", "ui"],
  gallery: ["connection", "format", "model", "ui"],
  scene_parts: ["connection", "format", "gen", "model", "ui"],
  statistics: ["format", "gen", "ui"],
  renderer: ["camera", "colour", "columns", "gen", "model"],
  ui: [
    ...["camera", "clock", "colour", "connection", "format", "gen", "model", "observed", "renderer"],
    ...["charts", "gallery", "scene_parts", "statistics", "tools"],
  ],
  tools: ["camera", "connection", "format", "model", "ui"],
  editor: ["format", "gen", "ui"],
  viewer: ["camera", "clock", "connection", "format", "model", "perf_marks", "renderer", "ticker", "ui"],
  test_api: ["camera", "clock", "connection", "model", "viewer"],
  main: ["connection", "model", "test_api", "ui", "viewer"],
};

const maxColumns = 120;

function filesBelow(folder: string, pattern: RegExp): string[] {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const file = path.join(folder, entry.name);
    if (entry.isDirectory()) return entry.name === "node_modules" ? [] : filesBelow(file, pattern);
    return pattern.test(entry.name) ? [file] : [];
  });
}

const sources = filesBelow("src", /(?<!\.d)\.ts$/);

/** The source files that a source file imports; types count, generated code is left out. */
function importsOf(file: string): string[] {
  const text = readFileSync(file, "utf8");
  return [...text.matchAll(/^(?:import|export)\b[^;]*?\bfrom "(\.[^"]+)"/gms)]
    .map(([, target = ""]) => `${path.join(path.dirname(file), target)}.ts`)
    .filter((target) => sources.includes(target));
}

function moduleOf(file: string): string {
  return (file.split(path.sep)[1] ?? "").replace(/\.ts$/, "");
}

test("every module imports only modules below it", () => {
  const wrong = sources.flatMap((file) => {
    const from = moduleOf(file);
    const targets = allowed[from];
    if (!targets) return [`${file}: module ${from} is missing in the list of this test`];
    return importsOf(file)
      .filter((target) => moduleOf(target) !== from && !targets.includes(moduleOf(target)))
      .map((target) => `${file} imports ${target}: ${from} may not use ${moduleOf(target)}`);
  });
  assert.deepEqual(wrong, []);
});

test("no imports form a cycle", () => {
  const cycles: string[] = [];
  const done = new Set<string>();
  const visit = (file: string, trail: string[]): void => {
    const start = trail.indexOf(file);
    if (start >= 0) cycles.push([...trail.slice(start), file].join(" -> "));
    if (start >= 0 || done.has(file)) return;
    for (const target of importsOf(file)) visit(target, [...trail, file]);
    done.add(file);
  };
  for (const file of sources) visit(file, []);
  assert.deepEqual(cycles, []);
});

test("no line has more than 120 columns", () => {
  const files = [
    ...sources.filter((file) => moduleOf(file) !== "gen"),
    ...filesBelow("tests", /\.ts$/),
    ...filesBelow("tools", /\.(ts|mjs)$/),
    ...filesBelow(path.join("..", "tests", "browser"), /\.test\.mjs$/),
    ...filesBelow(path.join("..", "tests", "browser", "support"), /\.mjs$/),
  ];
  const long = files.flatMap((file) =>
    readFileSync(file, "utf8")
      .split("\n")
      .flatMap((line, i) => ([...line].length > maxColumns ? [`${file}:${i + 1}: ${[...line].length} columns`] : [])),
  );
  assert.deepEqual(long, []);
});
