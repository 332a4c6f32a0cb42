// A certificate that nobody trusts who does not know the test's root.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

const program = `
import sys
from authorities import Authorities
print(*Authorities(sys.argv[1]).certify("page"), sep="\\n")
`;

/** Options of a server with a new certificate for 127.0.0.1, whose files are in the folder. */
export function tlsOptions(folder) {
  const modules = fileURLToPath(new URL("../../program", import.meta.url));
  const env = { ...process.env, PYTHONPATH: modules };
  const [chain, key] = execFileSync("python3", ["-B", "-c", program, folder], { env, encoding: "utf8" }).split("\n");
  return ["--tls-certificate", chain, "--tls-key", key];
}
