// Certificates from an authority of the test, which browsers do not trust.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

const program = `
import sys
from authorities import Authorities
authorities = Authorities(sys.argv[1])
print(authorities.root, *authorities.certify("server", sys.argv[2]), sep="\\n")
`;

/**
 * Creates a certificate in the folder for `places`, such as "DNS:localhost,IP:127.0.0.1". Returns the paths of the root
 * certificate, of the chain (leaf first, without the root) and of the key.
 */
export function certify(folder, places) {
  const modules = fileURLToPath(new URL("../../support/py", import.meta.url));
  const env = { ...process.env, PYTHONPATH: modules };
  const output = execFileSync("python3", ["-B", "-c", program, folder, places], { env, encoding: "utf8" });
  const [root, chain, key] = output.split("\n");
  return { root, chain, key };
}

/** Creates a certificate for 127.0.0.1 in the folder; returns the options of a server that uses it. */
export function tlsOptions(folder) {
  const { chain, key } = certify(folder, "DNS:localhost,IP:127.0.0.1");
  return ["--tls-certificate", chain, "--tls-key", key];
}
