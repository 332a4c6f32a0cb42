// Tests the proxy of docs/operations.md: Chromium connects to the server through a real nginx, which runs
// deploy/nginx/spherule.conf.
import assert from "node:assert/strict";
import http from "node:http";
import https from "node:https";
import { after, before, test } from "node:test";
import tls from "node:tls";
import { control, launch, open, when } from "../browser/support/browser.mjs";
import { serve, stopAll } from "../browser/support/server.mjs";
import { freePort, name, read, start } from "./support/nginx.mjs";

let ports;
let server;
let nginx;
let browser;

function serveBehind() {
  const settings = {
    SPHERULE_OPEN: "true",
    SPHERULE_HOST: `${name}:${ports.tls}`,
    SPHERULE_ORIGIN: `https://${name}:${ports.tls}`,
  };
  return serve("billiards", { port: ports.upstream, settings });
}

before(async () => {
  ports = { tls: await freePort(), plain: await freePort(), upstream: await freePort() };
  server = await serveBehind();
  nginx = await start(ports);
  browser = await launch(...nginx.switches);
});
after(async () => {
  await browser?.close();
  await nginx?.stop();
  await stopAll();
});

/** Returns status and headers of the proxy's answer. */
function ask(path, { plain = false, headers = {}, agent } = {}) {
  const [module, port] = plain ? [http, ports.plain] : [https, ports.tls];
  const host = plain ? name : `${name}:${ports.tls}`;
  return new Promise((resolve, reject) => {
    module
      .get({ host: "127.0.0.1", port, path, servername: name, ca: nginx.ca, agent, headers: { host, ...headers } })
      .on("response", (answer) => resolve(answer.resume()))
      .on("upgrade", (answer, socket) => resolve(socket.destroy() && answer))
      .on("error", reject);
  });
}

/** Returns the protocol of a TLS handshake, or its error. */
function shake(options) {
  return new Promise((resolve) => {
    const socket = tls.connect({ host: "127.0.0.1", port: ports.tls, servername: name, ca: nginx.ca, ...options });
    socket.on("secureConnect", () => resolve(socket.getProtocol())).on("error", (error) => resolve(error.code));
    socket.on("secureConnect", () => socket.destroy());
  });
}

test("the page loads over https and states come over wss", async () => {
  const page = await open(browser, nginx.url);
  const before = await page.evaluate(() => spherule.session.frames);
  await when(page, (then) => spherule.session.frames > then + 10, before);
  // A browser does not let an https page open a WebSocket without TLS.
  assert.equal(await page.evaluate(() => location.protocol), "https:");
  assert.deepEqual(page.faults, []);
  await page.close();
});

test("a server that ends says so through the proxy, and the page finds the next one", async () => {
  const page = await open(browser, nginx.url);
  await server.stop(); // throws unless the exit code is 0
  await when(page, (where) => document.querySelector(where).textContent !== "connected", control("connection"));
  assert.equal((await ask("/readyz")).statusCode, 502);
  server = await serveBehind();
  await when(page, (where) => document.querySelector(where).textContent === "connected", control("connection"));
  const before = await page.evaluate(() => spherule.session.frames);
  await when(page, (then) => spherule.session.frames > then + 3, before);
  await page.close();
});

test("the chain leads to the root, with TLS 1.2 and 1.3, and for this name only", async () => {
  assert.equal(await shake({}), "TLSv1.3");
  assert.equal(await shake({ maxVersion: "TLSv1.2" }), "TLSv1.2");
  const old = { minVersion: "TLSv1.1", maxVersion: "TLSv1.1", ciphers: "DEFAULT@SECLEVEL=0" };
  assert.match(await shake(old), /PROTOCOL_VERSION/);
  assert.match(await shake({ ca: undefined }), /SELF_SIGNED|UNABLE_TO_GET_ISSUER/);
  assert.match(await shake({ servername: "elsewhere.example.org" }), /UNRECOGNIZED_NAME/);
});

test("plain http leads to https, and figures stay inside", async () => {
  const plain = await ask("/?fixed", { plain: true });
  assert.deepEqual([plain.statusCode, plain.headers.location], [301, `https://${name}/?fixed`]);
  assert.equal((await ask("/metrics")).statusCode, 404);
  const inside = await ask("/readyz");
  assert.deepEqual([inside.statusCode, inside.headers["strict-transport-security"]], [200, "max-age=31536000"]);
});

test("the page's files stay compressed, and a client that has one gets 304", async () => {
  const headers = { "accept-encoding": "gzip" };
  const { statusCode, headers: sent } = await ask("/viewer.js", { headers });
  assert.deepEqual([statusCode, sent["content-encoding"], sent.vary], [200, "gzip", "Accept-Encoding"]);
  const again = await ask("/viewer.js", { headers: { ...headers, "if-none-match": sent.etag } });
  assert.deepEqual([again.statusCode, again.headers.etag], [304, sent.etag]);
});

test("the server sees the client's Host, Origin and wish to upgrade", async () => {
  await server.stop();
  const heard = [];
  const listening = http.createServer((request, answer) => answer.end(heard.push(request.headers) && "seen"));
  listening.on("upgrade", (request, socket) => {
    heard.push(request.headers);
    socket.end("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n");
  });
  await new Promise((resolve) => listening.listen(ports.upstream, "127.0.0.1", resolve));
  const origin = `https://${name}:${ports.tls}`;
  await ask("/", { headers: { origin } });
  await ask("/ws", { headers: { origin, connection: "Upgrade", upgrade: "websocket" } });
  await new Promise((resolve) => listening.close(resolve) && listening.closeAllConnections());
  server = await serveBehind();
  const host = `${name}:${ports.tls}`;
  assert.deepEqual(
    heard.map((headers) => [headers.host, headers.origin, headers.upgrade, headers.connection]),
    [
      [host, origin, undefined, "close"],
      [host, origin, "websocket", "upgrade"],
    ],
  );
});

test("it waits longer than the server, which says why it ends a silent stream", () => {
  const idle = Number(/idleTimeout\{([\d']+)\}/.exec(read("server/net/server.h"))[1].replace("'", ""));
  const stream = /location = \/ws \{([^}]+)\}/.exec(read("deploy/nginx/spherule.conf"))[1];
  for (const direction of ["read", "send"]) {
    const [, seconds] = new RegExp(`proxy_${direction}_timeout (\\d+)s;`).exec(stream);
    assert.ok(1000 * Number(seconds) > idle);
  }
});

test("who asks too much is refused", async () => {
  const statuses = async (path, count) => {
    const agent = new https.Agent({ keepAlive: true, maxSockets: 8 });
    const all = await Promise.all(Array.from({ length: count }, () => ask(path, { agent })));
    agent.destroy();
    return new Set(all.map((answer) => answer.statusCode));
  };
  assert.deepEqual([...(await statuses("/healthz", 20))], [200]);
  assert.ok((await statuses("/healthz", 120)).has(429));
  assert.ok((await statuses("/ws", 60)).has(429));
});
