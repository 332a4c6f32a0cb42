import { create, toBinary } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import { ClientMessageSchema } from "../gen/spherule/v1/control_pb";
import { sharedNow } from "../clock";
import { bufferOf } from "../columns";
import { BufferPool } from "./buffer_pool";
import { Frames } from "./frames";
import type { FromWorker, StreamRequest, ToWorker } from "./messages";
import { periodsOf } from "./periods";
import { clientName, decode, forPage } from "./protocol";
import { Socket } from "./socket";
import { Stream } from "./stream";

/** The connection's thread: holds the socket, decodes frames, and transfers states to the page without copying them. */

interface Port {
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
}
const page = globalThis as unknown as Port;

let socket: Socket | undefined;
const buffers = new BufferPool();
const frames = new Frames(buffers);
const stream = new Stream(frames, {
  ack: (ack) => void send({ case: "ack", value: ack }),
  decoded: (frame) => page.postMessage({ kind: "frame", frame }, [bufferOf(frame.columns)]),
  malformed: (reason) => page.postMessage({ kind: "unreadable", reason }),
  lost: (count) => page.postMessage({ kind: "lost", count }),
});

function send(kind: MessageInitShape<typeof ClientMessageSchema>["kind"]): boolean {
  const message = toBinary(ClientMessageSchema, create(ClientMessageSchema, { kind }));
  return socket?.send(message as Uint8Array<ArrayBuffer>) ?? false;
}

function received(data: ArrayBuffer): void {
  try {
    const arrival = sharedNow();
    const kind = decode(data);
    if (kind.case === "frame") return stream.receive(kind.value, arrival, data.byteLength);
    if (kind.case === "order") {
      const order = frames.setOrder(kind.value);
      if (order) page.postMessage({ kind: "order", order }, [order.places.buffer]);
      return;
    }
    if (kind.case === "scene") frames.setScene(kind.value.epoch, kind.value.count, periodsOf(kind.value));
    const message = forPage(kind);
    if (message) page.postMessage(message);
  } catch (error) {
    page.postMessage({ kind: "unreadable", reason: error instanceof Error ? error.message : String(error) });
  }
}

let view: StreamRequest | undefined;
let token = "";

function sendView(): void {
  send({ case: "view", value: view ?? {} });
}

function connect(url: string): void {
  socket = new Socket(url, {
    opened: () => {
      const at = sharedNow();
      stream.reset();
      send({ case: "hello", value: { client: clientName, view, token, turns: true, population: true } });
      page.postMessage({ kind: "link", state: "open", at });
    },
    received,
    changed: (change) => page.postMessage({ kind: "link", at: sharedNow(), ...change }),
    // The server answers a repeated view with the present stream, and changes nothing.
    probe: () => sendView(),
    silent: (duration) =>
      page.postMessage({ kind: "silent", since: duration === undefined ? undefined : sharedNow() - duration }),
  });
}

page.onmessage = ({ data }) => {
  switch (data.kind) {
    case "connect":
      view = data.view;
      token = data.token;
      connect(data.url);
      break;
    case "token":
      token = data.token;
      socket?.reconnect();
      break;
    case "retry":
      socket?.retry();
      break;
    case "view":
      view = data.view;
      sendView();
      break;
    case "drawing":
      stream.drawRate = data.rate;
      break;
    case "command":
      send({ case: "command", value: data.command });
      break;
    case "control":
      send(data.message);
      break;
    case "recycle":
      buffers.release(data.buffer);
      break;
  }
};
