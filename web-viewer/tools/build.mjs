// Bundles the page: viewer.js, worker.js, style.css and the files of src/page. The page fetches nothing from elsewhere.
import * as esbuild from "esbuild";
import { cpSync, mkdirSync, readFileSync } from "node:fs";
import path from "node:path";
import { generate } from "./generate.mjs";
import { options, root } from "./options.mjs";

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

const { out, protoc, debug } = options();
generate(protoc);
mkdirSync(out, { recursive: true });
await esbuild.build({
  absWorkingDir: root,
  entryPoints: {
    viewer: "src/main.ts",
    worker: "src/connection/worker.ts",
    style: "src/ui/style/style.css",
  },
  outdir: out,
  bundle: true,
  format: "iife",
  target: "es2022",
  minify: !debug,
  sourcemap: debug ? "inline" : false,
  legalComments: "none",
  loader: { ".glsl": "text" },
  plugins: [withoutFont],
  logLevel: "warning",
});
cpSync(path.join(root, "src/page"), out, { recursive: true });
