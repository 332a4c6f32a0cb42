// A second client that shares no code with the page: protobuf's JSON form over a WebSocket of its own.
import { readKeyframe } from "./keyframe.mjs";

/**
 * The scene's facts and the newest frame as the server tells them now, positions in metres by id. It asks for what the page
 * asks for, unless `view` says otherwise, so that both are sent the same quantised state.
 */
export async function serverSays(page, view = {}) {
  const { facts, settings, order, frame } = await page.evaluate(
    (wanted) =>
      new Promise((resolve, reject) => {
        const socket = new WebSocket(`ws://${location.host}/ws`, "spherule.v1");
        const heard = {};
        socket.onopen = () => socket.send(JSON.stringify({ hello: { client: "test", view: wanted } }));
        socket.onerror = () => reject(new Error("no connection"));
        socket.onmessage = ({ data }) => {
          const message = JSON.parse(data);
          if (message.scene) heard.facts = message.scene;
          if (message.settings) heard.settings = message.settings;
          if (message.order) heard.order = message.order;
          if (!message.frame) return;
          heard.frame = message.frame;
          socket.close();
          resolve(heard);
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
