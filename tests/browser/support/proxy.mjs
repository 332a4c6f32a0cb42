// A TCP proxy between page and server that simulates network failures, and counts the bytes of HTTP answers.
import net from "node:net";

const isStream = ({ sent }) => sent.startsWith("GET /ws");

/** Starts a proxy on a free port of 127.0.0.1. `target`: port of the server there. */
export async function proxyTo(target) {
  const pairs = new Set();
  const exchanges = []; // of each connection: what was sent to the server and received from it, as Latin 1
  let swallowing = false;
  let refusing = false;
  let stuttering = false;
  const server = net.createServer((from) => {
    if (refusing) {
      from.resetAndDestroy();
      return;
    }
    const pair = { from, to: net.connect(target, "127.0.0.1"), cut: swallowing };
    pairs.add(pair);
    let requested = false; // the first bytes, which are an HTTP request, have passed
    const exchange = { sent: "", received: "" };
    exchanges.push(exchange);
    const pass = (into) => (bytes) => {
      if (pair.cut) return;
      if (!isStream(exchange)) exchange[into === pair.to ? "sent" : "received"] += bytes.toString("latin1");
      into.write(bytes);
      if (stuttering && requested && into === pair.to) into.write(bytes);
      requested = true;
    };
    // An end that is cut off does not notice that the other has closed.
    const end = (other) => () => void (pair.cut || other.destroy());
    for (const [one, other] of [
      [pair.from, pair.to],
      [pair.to, pair.from],
    ]) {
      one.on("data", pass(other));
      one.on("close", end(other));
      one.on("error", () => {}); // "close" follows
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}/`,
    /**
     * Returns path and status of each answer over HTTP so far, as in "/style.css 200", and the bytes of all these
     * answers with their headers. Streams are left out.
     */
    files() {
      const plain = exchanges.filter((exchange) => !isStream(exchange));
      const answers = plain.flatMap(({ sent, received }) => {
        const statuses = [...received.matchAll(/HTTP\/1\.1 (\d{3}) /g)].map(([, status]) => status);
        return [...sent.matchAll(/^GET ([^ ?]+)/gm)].map(([, path], i) => `${path} ${statuses[i] ?? "unanswered"}`);
      });
      return { answers, bytes: plain.reduce((sum, { received }) => sum + received.length, 0) };
    },
    /** Resets all connections on both sides, and every new one, as a router does that has lost its state. */
    reset() {
      refusing = true;
      for (const { from, to } of pairs) {
        from.resetAndDestroy();
        to.resetAndDestroy();
      }
    },
    /** Drops all bytes from now on, without closing a connection. New connections are accepted and stay silent. */
    cut() {
      swallowing = true;
      for (const pair of pairs) pair.cut = true;
    },
    /** Whether all bytes from the page are sent twice, except its first request. */
    stutter(on) {
      stuttering = on;
    },
    /** Lets new connections work again. Connections that were cut stay so, because bytes are missing in them. */
    restore() {
      refusing = swallowing = false;
    },
    close() {
      server.close();
      for (const { from, to } of pairs) {
        from.destroy();
        to.destroy();
      }
    },
  };
}
