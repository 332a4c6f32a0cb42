// Modules of the page, bundled as the page has them, for tools and tests that run them in Node.
import * as esbuild from "esbuild";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { root } from "./options.mjs";

/** All that these modules export, named as they are imported in web-viewer. */
async function load(...names) {
  const folder = mkdtempSync(path.join(tmpdir(), "spherule-module-"));
  try {
    const outfile = path.join(folder, "module.mjs");
    await esbuild.build({
      stdin: { contents: names.map((name) => `export * from "${name}";`).join("\n"), resolveDir: root },
      outfile,
      bundle: true,
      format: "esm",
      target: "es2022",
      minify: true,
    });
    return await import(pathToFileURL(outfile));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** The decoder of frames. */
export function loadDecoder() {
  return load("./src/codec/decoder.ts");
}

/** The protocol's messages, and what reads and writes them; the page must have been built before. */
export function loadMessages() {
  return load("@bufbuild/protobuf", "./src/gen/spherule/v1/control_pb.ts");
}
