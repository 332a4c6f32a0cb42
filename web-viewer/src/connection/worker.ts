import { create, toBinary } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import { ClientMessageSchema } from "../gen/spherule/v1/control_pb";
import { sharedNow } from "../clock";
import { sentence } from "../format";
import type { Welcome } from "../gen/spherule/v1/control_pb";
import { askArchive } from "./archivist";
import { BufferPool } from "./buffer_pool";
import { FilePlayback } from "./file_playback";
import { fileNameOf } from "./file_name";
import { Frames, noContent } from "./frames";
import { LookBack } from "./look_back";
import { endsReplay, isLocal } from "./messages";
import type { CommandMessage, FromWorker, PastRange, Received, StreamRequest, ToWorker } from "./messages";
import { PagePort } from "./page_port";
import { periodsOf } from "./periods";
import { clientName, decode, forPage } from "./protocol";
import { Replay } from "./replay";
import { Socket } from "./socket";
import { Stream } from "./stream";

/** The connection's thread: holds the socket, decodes frames, and transfers states to the page without copying them. */

interface Port {
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
}
const page = globalThis as unknown as Port;
const port = new PagePort((message, transfer) => page.postMessage(message, transfer));

const historyPeriod = 250; // ms between two reports of the past that can be shown

let socket: Socket | undefined;
let plays = false; // the server plays a recording, which has a past of its own
let newest: Received | undefined; // state of the server, without content
let replay: Replay | undefined; // shown in place of the server's frames
let file: FilePlayback | undefined; // whose replay it is
let welcome: Welcome | undefined;
let lastReport = 0; // ms
const lookBack = new LookBack();
const buffers = new BufferPool();
const frames = new Frames(buffers);
const stream = new Stream(frames, {
  ack: (ack) => void send({ case: "ack", value: ack }),
  decoded: (state, frame, message, keyframe) => {
    newest = { ...state, ...noContent };
    if (!plays) lookBack.frameDecoded(frame, message, keyframe, frames);
    const at = plays ? undefined : lookBack.history.end;
    if (!replay) port.show({ ...state, at }, frames);
    reportPast(state.arrival);
  },
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
    const bytes = new Uint8Array(data);
    const kind = decode(bytes);
    if (kind.case === "frame") return stream.receive(kind.value, bytes, arrival);
    if (kind.case === "order") return frames.setOrder(kind.value);
    if (kind.case === "scene") {
      frames.setScene(kind.value.epoch, kind.value.count, periodsOf(kind.value));
      lookBack.sceneReceived(kind.value);
    }
    if (kind.case === "welcome") welcome = kind.value;
    if (kind.case === "settings") lookBack.settings = kind.value;
    if (kind.case === "population") lookBack.populationReceived(kind.value);
    if (kind.case === "timeline") {
      plays = true;
      if (!file) showPresent();
      lookBack.clear();
    }
    const ofPresent = kind.case === "scene" || kind.case === "population";
    const message = replay && ofPresent ? undefined : forPage(kind);
    if (message) page.postMessage(message);
  } catch (error) {
    page.postMessage({ kind: "unreadable", reason: error instanceof Error ? error.message : String(error) });
  }
}

function past(): PastRange | undefined {
  const { begin, history } = lookBack;
  const { end, frames: count } = history;
  return !plays && count > 0 ? { begin, end, frames: count } : undefined;
}

function reportPast(now: number): void {
  if (now - lastReport < historyPeriod) return;
  lastReport = now;
  page.postMessage({ kind: "past", past: past() });
}

/** Call before a seek to the past. */
function leavePresent(): Replay {
  stream.shown = false;
  lookBack.keep(true);
  return new Replay("past", lookBack.history, newest?.status?.paused ?? false, buffers, port, () => showPresent());
}

function showPresent(): void {
  if (!replay) return;
  const { source } = replay.state;
  replay.stop();
  replay = file = undefined;
  stream.shown = true;
  lookBack.keep(false);
  port.post({ kind: "replay", replay: undefined });
  if (source === "file") return socket?.reconnect();
  const { facts } = lookBack;
  if (facts) port.post({ kind: "scene", facts, jump: true });
  const content = frames.newest;
  if (newest && content) port.show({ ...newest, ...content, arrival: sharedNow() }, frames);
}

function commanded(command: CommandMessage): void {
  const name = command.kind?.case;
  if (!name || !isLocal(name, replay?.state, past())) {
    if (name && endsReplay(name)) showPresent();
    return void send({ case: "command", value: command });
  }
  if (file) return file.carryOut(command);
  replay ??= leavePresent();
  replay.carryOut(command);
}

async function save(): Promise<void> {
  try {
    const segments = lookBack.history.all;
    const { file: written } = await askArchive({ kind: "write", segments, welcome }, "written");
    port.post({ kind: "saved", file: written, name: fileNameOf(lookBack.facts?.name ?? "", ".sph") });
  } catch (error) {
    tell("Not saved", error);
  }
}

async function open(recording: File): Promise<void> {
  const { name } = recording;
  try {
    const { content } = await askArchive({ kind: "read", file: recording, name }, "read");
    socket?.close();
    replay?.stop();
    lookBack.clear();
    newest = undefined;
    file = new FilePlayback(name, content, buffers, port);
    replay = file.replay;
  } catch (error) {
    tell(`${name} cannot be played`, error);
  }
}

function tell(title: string, error: unknown): void {
  port.post({ kind: "told", title, text: sentence(error instanceof Error ? error.message : String(error)) });
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
      plays = false;
      lookBack.connected();
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
      if (!file) socket?.retry();
      break;
    case "view":
      view = data.view;
      sendView();
      break;
    case "drawing":
      stream.drawRate = data.rate;
      break;
    case "command":
      commanded(data.command);
      break;
    case "present":
      showPresent();
      break;
    case "save":
      void save();
      break;
    case "open":
      void open(data.file);
      break;
    case "control":
      send(data.message);
      break;
    case "recycle":
      buffers.release(data.buffer);
      break;
  }
};
