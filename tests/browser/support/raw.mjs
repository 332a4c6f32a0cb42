// A second client that shares no code with the page: protobuf's JSON form over a WebSocket of its own.
import { cellsOf } from "./keyframe.mjs";

/** The scene's facts and the newest frame as the server tells them now, positions in metres. */
export async function serverSays(page) {
  const { facts, settings, order, frame } = await page.evaluate(
    () =>
      new Promise((resolve, reject) => {
        const socket = new WebSocket(`ws://${location.host}/ws`, "spherule.v1");
        const heard = {};
        socket.onopen = () => socket.send(JSON.stringify({ hello: { client: "test" } }));
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
  );
  const ids = Buffer.from(order.ids, "base64");
  const centre = facts.boundsMin.map((low, axis) => (low + facts.boundsMax[axis]) / 2);
  const positions = [];
  cellsOf(Buffer.from(frame.spb, "base64")).forEach((cell, k) => {
    positions[ids.readUIntLE(3 * k, 3)] = cell.map((q, axis) => centre[axis] + frame.quantum * q);
  });
  return { facts, settings, step: Number(frame.step ?? 0), epoch: frame.epoch, positions, quantum: frame.quantum };
}
