// Bundles the page: viewer.js, worker.js, style.css and the files of src/page. The page fetches nothing from elsewhere.
// Each file is also compressed, as NAME.gz. Fails if what a first visit loads is larger than `limit`, compressed, or if
// the protobuf library is in viewer.js, too.
import { execFileSync } from "node:child_process";
import * as esbuild from "esbuild";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { gzipSync } from "node:zlib";
import { generate } from "./generate.mjs";
import { options, root } from "./options.mjs";

const limit = 117_000; // bytes; with the headers of the responses, a first visit loads less than 120,000

/** Removes the font from lil-gui's style sheet: the security policy forbids it, and the page draws its own arrows. */
const withoutFont = {
  name: "without font",
  setup(build) {
    build.onLoad({ filter: /lil-gui\.css$/ }, ({ path: file }) => {
      const whole = readFileSync(file, "utf8");
      const contents = whole.replace(/@font-face\s*\{[^}]*\}/, "");
      if (contents === whole) throw new Error("the style sheet of lil-gui has no font any more: remove this plugin");
      return { contents, loader: "css" };
    });
  },
};

/** Removes the copy of lil-gui's style sheet from its code: the page has the sheet in style.css. */
const withoutSheet = {
  name: "without sheet",
  setup(build) {
    build.onLoad({ filter: /lil-gui\.esm\.js$/ }, ({ path: file }) => {
      const whole = readFileSync(file, "utf8");
      const contents = whole.replace(/(stylesheet = )`[^`]*`/, '$1""');
      if (contents === whole) throw new Error("the code of lil-gui has no style sheet any more: remove this plugin");
      return { contents, loader: "js" };
    });
  },
};

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
  plugins: [withoutFont, withoutSheet, shortShaders],
});
// Parts of the page that it loads when it needs them: see src/ui/parts.ts.
const names = ["charts", "editor", "gallery", "statistics", "tools"];
const parts = Object.fromEntries(names.map((name) => [name, `src/${name}/${name}.ts`]));
const lazy = await esbuild.build({ ...common, entryPoints: parts, format: "esm", loader: { ".css": "text" } });
const viewer = Object.values(metafile.outputs).find(({ entryPoint }) => entryPoint === "src/main.ts");
const library = Object.entries(viewer.inputs).find(([file, used]) => used.bytesInOutput && file.includes("@bufbuild/"));
if (library) throw new Error(`viewer.js contains ${library[0]}: only the worker may encode and decode messages`);

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
