// Generates src/gen from the .proto files, with protoc and its plugin for ES modules.
import { execFileSync } from "node:child_process";
import { mkdirSync, readdirSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { options, root } from "./options.mjs";

export function generate(protoc) {
  const protos = path.resolve(root, "../proto");
  const folder = "spherule/v1";
  const files = readdirSync(path.join(protos, folder)).filter((name) => name.endsWith(".proto"));
  const out = path.join(root, "src/gen");
  mkdirSync(out, { recursive: true });
  execFileSync(
    protoc,
    [
      `--plugin=protoc-gen-es=${path.join(root, "node_modules/.bin/protoc-gen-es")}`,
      `--es_out=${out}`,
      "--es_opt=target=ts",
      `--proto_path=${protos}`,
      ...files.map((name) => path.join(protos, folder, name)),
    ],
    { stdio: "inherit" },
  );
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) generate(options().protoc);
