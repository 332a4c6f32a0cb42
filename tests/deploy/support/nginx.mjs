// A real nginx that runs deploy/nginx/spherule.conf with other ports and paths.
import { execFileSync, spawn } from "node:child_process";
import { chmodSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { certify } from "../../browser/support/certificate.mjs";

export const name = "spherule.example.org";

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), "../../..");
const program = ["/usr/sbin/nginx", path.join(root, "build/nginx/usr/sbin/nginx")].find(existsSync);

export async function freePort() {
  const server = net.createServer();
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

/** Returns the content of a file of the repository. */
export const read = (file) => readFileSync(path.join(root, file), "utf8");

/** Starts nginx, which passes requests to the server. Ports of 127.0.0.1: `tls` (https), `plain` (http), `upstream`. */
export async function start({ tls, plain, upstream }) {
  const folder = mkdtempSync(path.join(os.tmpdir(), "spherule-nginx-"));
  chmodSync(folder, 0o755); // nginx's workers run as another user
  const { root: authority, chain, key } = certify(folder, `DNS:${name}`);
  let site = read("deploy/nginx/spherule.conf");
  for (const [written, here] of [
    ["listen 80;", `listen 127.0.0.1:${plain};`],
    ["listen 443 ssl", `listen 127.0.0.1:${tls} ssl`],
    ["server 127.0.0.1:8080;", `server 127.0.0.1:${upstream};`],
    ["/etc/nginx/tls/spherule.pem", chain],
    ["/etc/nginx/tls/spherule.key", key],
  ]) {
    if (!site.includes(written)) throw new Error(`spherule.conf has no "${written}"`);
    site = site.replaceAll(written, here);
  }
  writeFileSync(path.join(folder, "site.conf"), site);
  const temporary = ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"].map((one) => `${one}_temp_path temp-${one};`);
  writeFileSync(
    path.join(folder, "nginx.conf"),
    `daemon off; pid nginx.pid; error_log stderr crit; worker_processes 1; events {}
     http { access_log off; ${temporary.join(" ")} include site.conf; }`,
  );
  const words = ["-p", folder, "-e", "stderr", "-c", "nginx.conf"];
  execFileSync(program, [...words, "-t", "-q"]); // throws an Error with nginx's output
  const child = spawn(program, words, { stdio: ["ignore", "ignore", "inherit"] });
  const ended = new Promise((resolve) => child.once("exit", resolve));
  while (!(await answers(tls))) if (child.exitCode !== null) throw new Error("nginx has ended");
  return {
    ca: readFileSync(authority, "utf8"),
    url: `https://${name}:${tls}/`,
    /** Options with which Chromium resolves the name to 127.0.0.1 and trusts this certificate. */
    switches: [`--host-resolver-rules=MAP ${name} 127.0.0.1`, `--ignore-certificate-errors-spki-list=${pin(chain)}`],
    async stop() {
      child.kill("SIGQUIT");
      const code = await ended;
      rmSync(folder, { recursive: true });
      if (code !== 0) throw new Error(`nginx ended with ${code}`);
    },
  };
}

/** Returns the hash of the public key of the first certificate, in the form that Chromium's option takes. */
function pin(chain) {
  const shell = "openssl x509 -in $0 -noout -pubkey | openssl pkey -pubin -outform der | openssl dgst -sha256 -binary";
  return execFileSync("sh", ["-c", shell, chain]).toString("base64");
}

async function answers(port) {
  await new Promise((resolve) => setTimeout(resolve, 50));
  return new Promise((resolve) => {
    const socket = net.connect(port, "127.0.0.1", () => resolve(true));
    socket.on("error", () => resolve(false)).on("connect", () => socket.destroy());
  });
}
