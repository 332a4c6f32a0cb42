import { create, toBinary } from "@bufbuild/protobuf";
import { ClientMessageSchema, HelloSchema } from "../gen/spherule/v1/control_pb";
import type { ClientMessage } from "../gen/spherule/v1/control_pb";
import { sharedNow } from "../clock";
import { decode } from "./decode";
import type { FromWorker, ToWorker } from "./messages";
import { Socket } from "./socket";

/** The connection's thread: holds the socket, decodes, hands states over without copying them. */

interface Port {
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
}
const page = globalThis as unknown as Port;

const rate = 30; // state frames per second
const spare: ArrayBuffer[] = [];

function take(bytes: number): ArrayBuffer {
  const used = spare.pop();
  return used && used.byteLength >= bytes ? used : new ArrayBuffer(bytes);
}

let socket: Socket | undefined;

function send(kind: ClientMessage["kind"]): boolean {
  const message = toBinary(ClientMessageSchema, create(ClientMessageSchema, { kind }));
  return socket?.send(message as Uint8Array<ArrayBuffer>) ?? false;
}

function received(data: ArrayBuffer): void {
  try {
    const message = decode(data, sharedNow(), take);
    if (!message) return;
    const transfer = message.kind === "frame" ? [message.frame.positions.buffer as ArrayBuffer] : [];
    page.postMessage(message, transfer);
  } catch (error) {
    page.postMessage({ kind: "broken", reason: error instanceof Error ? error.message : String(error) });
  }
}

function connect(url: string): void {
  socket = new Socket(url, {
    opened: () => {
      send({ case: "hello", value: create(HelloSchema, { client: "spherule viewer", rate }) });
      page.postMessage({ kind: "link", state: "open" });
    },
    received,
    state: (state, retryIn, reason) => page.postMessage({ kind: "link", state, retryIn, reason }),
  });
}

page.onmessage = ({ data }) => {
  switch (data.kind) {
    case "connect":
      connect(data.url);
      break;
    case "retry":
      socket?.retry();
      break;
    case "command":
      send({ case: "command", value: data.command });
      break;
    case "recycle":
      if (spare.length < 4) spare.push(data.buffer);
      break;
  }
};
