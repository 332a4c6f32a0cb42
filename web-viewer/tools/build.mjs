// Bundles the page: index.html, viewer.js, worker.js, style.css, favicon.svg, and nothing fetched from elsewhere.
import * as esbuild from "esbuild";
import { copyFileSync, mkdirSync } from "node:fs";
import path from "node:path";
import { generate } from "./generate.mjs";
import { options, root } from "./options.mjs";

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
  logLevel: "warning",
});
for (const file of ["index.html", "favicon.svg"]) {
  copyFileSync(path.join(root, "src/page", file), path.join(out, file));
}
