// Certificates as a public authority issues them: a root that clients trust, an intermediate, and a server certificate.
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";

/** Writes chain.pem, leaf first and without its root, and leaf.key into the folder; returns the root certificate. */
export function certify(folder, name) {
  const at = (file) => path.join(folder, file);
  const issue = (subject, issuer, ...extensions) =>
    execFileSync(
      "openssl",
      ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2"]
        .concat(["-subj", `/CN=${subject}`, "-keyout", at(`${subject}.key`), "-out", at(`${subject}.pem`)])
        .concat(issuer ? ["-CA", at(`${issuer}.pem`), "-CAkey", at(`${issuer}.key`)] : [])
        .concat(extensions.flatMap((extension) => ["-addext", extension])),
      { stdio: ["ignore", "ignore", "pipe"] },
    );
  issue("root", null, "keyUsage=critical,keyCertSign");
  issue("between", "root", "keyUsage=critical,keyCertSign");
  issue("leaf", "between", `subjectAltName=DNS:${name}`, "basicConstraints=critical,CA:FALSE");
  const [root, between, leaf] = ["root", "between", "leaf"].map((one) => readFileSync(at(`${one}.pem`), "utf8"));
  writeFileSync(at("chain.pem"), leaf + between);
  return root;
}
