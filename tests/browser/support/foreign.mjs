// A foreign site, whose pages try to use a server that the visitor's browser can reach.
import http from "node:http";

/** Starts a site of empty pages on a free port of 127.0.0.1. */
export async function foreignSite() {
  const server = http.createServer((_, response) => {
    response.writeHead(200, { "Content-Type": "text/html" }).end("<!doctype html><title>Foreign</title>");
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  server.unref(); // a failed test may not close it
  const { port } = server.address();
  return {
    url: `http://127.0.0.1:${port}/`,
    origin: `http://127.0.0.1:${port}`,
    port,
    async close() {
      server.closeAllConnections();
      await new Promise((resolve) => server.close(resolve));
    },
  };
}

/**
 * Tries to use the server from a page. `stream` is "commanded", or says how the WebSocket ended. The other results are
 * an HTTP status, "opaque", or "nothing".
 */
export function reach(page, url) {
  return page.evaluate(async (target) => {
    const read = async (path, options) => {
      try {
        const answer = await fetch(target + path, options);
        return answer.type === "opaque" ? "opaque" : answer.status;
      } catch {
        return "nothing";
      }
    };
    const stream = await new Promise((resolve) => {
      let opened = false;
      const socket = new WebSocket(`${target.replace("http", "ws")}ws`, "spherule.v1");
      socket.onopen = () => {
        opened = true;
        socket.send(JSON.stringify({ hello: { client: "foreign", view: { rate: 0 } } }));
        socket.send(JSON.stringify({ command: { id: 1, pause: {} } }));
      };
      socket.onmessage = ({ data }) => {
        if (JSON.parse(data).result?.applied) resolve("commanded");
      };
      socket.onclose = ({ code }) => resolve(opened ? `closed with ${code}` : "not opened");
    });
    return {
      stream,
      metrics: await read("metrics"),
      guess: await read("metrics", { headers: { Authorization: "Bearer a-guess-of-a-foreign-page" } }),
      ready: await read("readyz"),
      blind: await read("readyz", { mode: "no-cors" }),
    };
  }, url);
}
