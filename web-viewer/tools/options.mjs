import { parseArgs } from "node:util";
import { fileURLToPath } from "node:url";
import path from "node:path";

export const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "..");

/** Options of the build: the output folder, the protoc to use, and whether to keep the output readable. */
export function options() {
  const { values } = parseArgs({
    options: {
      out: { type: "string", default: path.join(root, "dist") },
      protoc: { type: "string", default: "protoc" },
      debug: { type: "boolean", default: false },
    },
  });
  return { out: path.resolve(values.out), protoc: values.protoc, debug: values.debug };
}
