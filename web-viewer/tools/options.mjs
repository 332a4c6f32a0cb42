import { parseArgs } from "node:util";
import { fileURLToPath } from "node:url";
import path from "node:path";

export const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "..");

/** What the build takes: where the page goes, which protoc makes the message code, whether to keep it readable. */
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
