// A second client that shares no code with the page: protobuf's JSON form over a WebSocket of its own.

/** The scene's facts and the newest frame as the server tells them now, positions in metres. */
export async function serverSays(page) {
  const { facts, settings, frame } = await page.evaluate(
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
          if (!message.frame) return;
          heard.frame = message.frame;
          socket.close();
          resolve(heard);
        };
      }),
  );
  const units = Buffer.from(frame.states.packed16.positions, "base64");
  const { originX = 0, originY = 0, originZ = 0, quantum } = facts.grid;
  const positions = Array.from({ length: frame.count }, (_, id) =>
    [originX, originY, originZ].map((origin, axis) => origin + quantum * units.readUInt16LE(6 * id + 2 * axis)),
  );
  return { facts, settings, step: Number(frame.step ?? 0), epoch: frame.epoch, positions, quantum };
}
