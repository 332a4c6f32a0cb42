// The page's decoder, bundled as the page has it, for tools that run it in Node.
import * as esbuild from "esbuild";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { root } from "./options.mjs";

/** The module src/codec/decoder.ts. */
export async function loadDecoder() {
  const folder = mkdtempSync(path.join(tmpdir(), "spherule-codec-"));
  try {
    const outfile = path.join(folder, "decoder.mjs");
    await esbuild.build({
      entryPoints: [path.join(root, "src/codec/decoder.ts")],
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
