// A certificate from an authority of the test, which browsers do not trust.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

const program = `
import sys
from authorities import Authorities
print(*Authorities(sys.argv[1]).certify("page"), sep="\\n")
`;

/** Creates a certificate for 127.0.0.1 in the folder; returns the options of a server that uses it. */
export function tlsOptions(folder) {
  const modules = fileURLToPath(new URL("../../program", import.meta.url));
  const env = { ...process.env, PYTHONPATH: modules };
  const [chain, key] = execFileSync("python3", ["-B", "-c", program, folder], { env, encoding: "utf8" }).split("\n");
  return ["--tls-certificate", chain, "--tls-key", key];
}
