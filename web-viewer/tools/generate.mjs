// Generates src/gen from the .proto files, with protoc and its plugin for ES modules.
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { fromBinary, toBinary } from "@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";
import { options, root } from "./options.mjs";

const RULES = "spherule/v1/rules.proto";

/**
 * Removes the rules of fields: of the scene, and of commands. The page does not read them, and they would be part of
 * the first load.
 */
function withoutRules(binary) {
  const set = fromBinary(FileDescriptorSetSchema, binary);
  for (const file of set.file) {
    file.dependency = file.dependency.filter((name) => name !== RULES);
    for (const message of file.messageType)
      for (const ruled of [...message.field, ...message.oneofDecl]) ruled.options = undefined;
  }
  set.file = set.file.filter((file) => file.name !== RULES);
  return toBinary(FileDescriptorSetSchema, set);
}

export function generate(protoc) {
  const protos = path.resolve(root, "../proto");
  const folder = "spherule/v1";
  const files = readdirSync(path.join(protos, folder))
    .filter((name) => name.endsWith(".proto"))
    .map((name) => `${folder}/${name}`);
  const out = path.join(root, "src/gen");
  mkdirSync(out, { recursive: true });
  const temporary = mkdtempSync(path.join(tmpdir(), "spherule-"));
  const descriptors = path.join(temporary, "descriptors");
  const withComments = ["--include_imports", "--include_source_info", `--descriptor_set_out=${descriptors}`];
  execFileSync(protoc, [...withComments, `--proto_path=${protos}`, ...files], { stdio: "inherit" });
  writeFileSync(descriptors, withoutRules(readFileSync(descriptors)));
  const plugin = [
    `--plugin=protoc-gen-es=${path.join(root, "node_modules/.bin/protoc-gen-es")}`,
    `--es_out=${out}`,
    "--es_opt=target=ts",
  ];
  const input = [`--descriptor_set_in=${descriptors}`, ...files.filter((name) => name !== RULES)];
  execFileSync(protoc, [...plugin, ...input], { stdio: "inherit" });
  rmSync(temporary, { recursive: true });
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) generate(options().protoc);
