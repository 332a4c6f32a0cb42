// Bundles the page: viewer.js, worker.js, style.css and the files of src/page. The page fetches nothing from elsewhere.
// Each file is also compressed, as NAME.gz. Fails if what a first visit loads is larger than `limit`, compressed, or if
// a bundle contains a library that belongs to another one.
import { execFileSync } from "node:child_process";
import * as esbuild from "esbuild";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { gzipSync } from "node:zlib";
import { fromBinary, toBinary } from "@bufbuild/protobuf";
import { FileDescriptorProtoSchema } from "@bufbuild/protobuf/wkt";
import { generate } from "./generate.mjs";
import { options, root } from "./options.mjs";

const limit = 117_000; // bytes; with the headers of the responses, a first visit loads less than 120,000

/** Removes comments, indentation, most ends of lines, spaces around punctuation and needless zeros from shaders. */
const shortShaders = {
  name: "short shaders",
  setup(build) {
    build.onLoad({ filter: /\.glsl$/ }, ({ path: file }) => {
      const lines = readFileSync(file, "utf8")
        .replace(/\s*\/\/.*$/gm, "")
        .split("\n");
      const short = (line) =>
        line
          .replace(/\s*([=*/(){},;?:<>+&|])\s*/g, "$1")
          .replace(/ - (?!-)/g, "-")
          .replace(/\b0(\.\d)/g, "$1")
          .replace(/(\d\.)0\b/g, "$1");
      const contents = lines
        .map((line) => (line.startsWith("#") ? line : short(line.trim())))
        .filter((line) => line !== "")
        .join("\n")
        .replace(/([;{},(&|=+])\n(?!#)/g, "$1");
      return { contents, loader: "text" };
    });
  },
};

/** Removes the names of enumerators. Only JSON has them, which these bundles do not read or write. */
function withoutEnumerators(binary) {
  const file = fromBinary(FileDescriptorProtoSchema, binary);
  const clear = ({ enumType, nestedType = [] }) => {
    for (const value of enumType.flatMap((one) => one.value)) value.name = "";
    nestedType.forEach(clear);
  };
  clear({ ...file, nestedType: file.messageType });
  return toBinary(FileDescriptorProtoSchema, file);
}

/** Writes the descriptors of generated code as text: gzip finds their repeated names, which base64 hides. */
const plainDescriptors = {
  name: "plain descriptors",
  setup(build) {
    build.onLoad({ filter: /_pb\.ts$/ }, ({ path: file }) => {
      const plain = (_, base64) => {
        const binary = withoutEnumerators(Buffer.from(base64, "base64"));
        return `fileDesc(/*@__PURE__*/ btoa(${JSON.stringify(Buffer.from(binary).toString("latin1"))})`;
      };
      return { contents: readFileSync(file, "utf8").replace(/fileDesc\("([^"]+)"/, plain), loader: "ts" };
    });
  },
};

const { out, protoc, debug } = options();
generate(protoc);
const common = {
  absWorkingDir: root,
  outdir: out,
  write: false,
  bundle: true,
  target: "es2022",
  minify: !debug,
  sourcemap: debug ? "inline" : false,
  legalComments: "none",
  logLevel: "warning",
};
const { outputFiles, metafile } = await esbuild.build({
  ...common,
  entryPoints: {
    viewer: "src/main.ts",
    worker: "src/connection/worker.ts",
    archive: "src/archive/worker.ts",
    style: "src/ui/style/style.css",
  },
  metafile: true,
  format: "iife",
  plugins: [shortShaders, plainDescriptors],
});
// Parts of the page that it loads when it needs them: see src/ui/parts.ts.
const names = ["charts", "editor", "gallery", "scene_parts", "statistics", "tools"];
const parts = Object.fromEntries(names.map((name) => [name, `src/${name}/${name}.ts`]));
const lazy = await esbuild.build({
  ...common,
  entryPoints: parts,
  metafile: true,
  format: "esm",
  loader: { ".css": "text" },
});
const viewer = Object.values(metafile.outputs).find(({ entryPoint }) => entryPoint === "src/main.ts");
/** Throws an Error if a bundle contains a library. */
function forbid({ entryPoint, inputs }, library, why) {
  const found = Object.entries(inputs).find(([file, used]) => used.bytesInOutput && file.includes(library));
  if (found) throw new Error(`the bundle of ${entryPoint} contains ${found[0]}: ${why}`);
}

forbid(viewer, "@bufbuild/", "only the worker may encode and decode messages");
for (const bundle of Object.values(metafile.outputs).filter(({ entryPoint }) => entryPoint?.endsWith("/worker.ts")))
  for (const module of ["from-json", "to-json"]) forbid(bundle, module, "its enumerators have no names");
// Effects follow only the signals of their own copy of the library.
for (const part of Object.values(lazy.metafile.outputs)) forbid(part, "@preact/", "only viewer.js has signals");

const pages = path.join(root, "src/page");
const pageFiles = readdirSync(pages, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
const files = [
  ...[...outputFiles, ...lazy.outputFiles].map((file) => ({ name: path.basename(file.path), bytes: file.contents })),
  ...pageFiles.map(({ path: folder, name }) => ({
    name: path.relative(pages, path.join(folder, name)),
    bytes: readFileSync(path.join(folder, name)),
  })),
];
for (const { name, bytes } of files) {
  const file = path.join(out, name);
  mkdirSync(path.dirname(file), { recursive: true });
  writeFileSync(file, bytes);
}

// The gallery loads pictures when it opens, and the page loads archive.js when it writes or reads a recording.
const loadedLater = ["archive.js", ...names.map((part) => `${part}.js`)];
const isFirst = ({ name }) => !name.endsWith(".webp") && !loadedLater.includes(name);

/** Zopfli finds a shorter gzip file than zlib, in more time. */
function compress(file) {
  if (debug || !isFirst(file)) return gzipSync(file.bytes, { level: 9 });
  return execFileSync("zopfli", ["-c", path.join(out, file.name)], { maxBuffer: 2 ** 24 });
}

let sum = 0; // bytes of the first load
for (const file of files) {
  const compressed = compress(file);
  writeFileSync(path.join(out, `${file.name}.gz`), compressed);
  if (!isFirst(file)) continue;
  console.log(`${String(compressed.length).padStart(7)} ${file.name}.gz`);
  sum += compressed.length;
}
console.log(`${String(sum).padStart(7)} bytes together`);
// A page for debugging has its source maps inside.
if (sum > limit && !debug) throw new Error(`the first load has ${sum} compressed bytes; at most ${limit} are allowed`);
