// A client that shares no code with the page. It uses the JSON form of the messages.
import { readKeyframe } from "./keyframe.mjs";

/**
 * Queries the server's scene facts, settings and newest frame. Returns positions in m, by id. It requests the page's
 * default view unless `view` overrides it, so that both receive the same quantised state.
 */
export async function queryServer(page, view = {}) {
  const { facts, settings, order, frame } = await page.evaluate(
    (wanted) =>
      new Promise((resolve, reject) => {
        const socket = new WebSocket(`ws://${location.host}/ws`, "spherule.v1");
        const received = {};
        socket.onopen = () => socket.send(JSON.stringify({ hello: { client: "test", view: wanted } }));
        socket.onerror = () => reject(new Error("no connection"));
        socket.onmessage = ({ data }) => {
          const message = JSON.parse(data);
          if (message.scene) received.facts = message.scene;
          if (message.settings) received.settings = message.settings;
          if (message.order) received.order = message.order;
          if (!message.frame) return;
          received.frame = message.frame;
          socket.close();
          resolve(received);
        };
      }),
    { fixed: true, ...view },
  );
  if (frame.order !== order.number || frame.epoch !== order.epoch) throw new Error("a frame without its order");
  const ids = Buffer.from(order.ids, "base64");
  const centre = [0, 1, 2].map((axis) => (facts.boundsMin[axis] + facts.boundsMax[axis]) / 2);
  const positions = [];
  readKeyframe(Buffer.from(frame.spb, "base64")).forEach((place, k) => {
    positions[ids.readUIntLE(3 * k, 3)] = place.map((q, axis) => centre[axis] + frame.quantum * q);
  });
  return { facts, settings, step: Number(frame.step ?? 0), epoch: frame.epoch, positions, quantum: frame.quantum };
}
