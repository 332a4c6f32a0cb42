// A TCP proxy between page and server, whose network can fail in ways that a server on the same machine cannot show.
import net from "node:net";

/** Listens on a free port of 127.0.0.1 and passes all on to `target` there. */
export async function proxyTo(target) {
  const pairs = new Set();
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
    let asked = false; // for the page, or for the stream
    const pass = (into) => (bytes) => {
      if (pair.cut) return;
      into.write(bytes);
      if (stuttering && asked && into === pair.to) into.write(bytes);
      asked = true;
    };
    // Who is cut off does not hear that the other has left.
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
    /** Ends all connections as a router does that has forgotten them: both sides get a reset; so does who comes anew. */
    reset() {
      refusing = true;
      for (const { from, to } of pairs) {
        from.resetAndDestroy();
        to.resetAndDestroy();
      }
    },
    /**
     * From now on, bytes vanish both ways and nobody is told: connections stay open, and new ones are taken and stay silent.
     */
    cut() {
      swallowing = true;
      for (const pair of pairs) pair.cut = true;
    },
    /** Whatever a page says after its first request comes twice, or no longer does. */
    stutter(on) {
      stuttering = on;
    },
    /** New connections work again. What was cut stays so: bytes are missing in it. */
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
