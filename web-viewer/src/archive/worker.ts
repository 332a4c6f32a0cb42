import type { FromArchive, ToArchive } from "../connection/archive_messages";
import { readRecording } from "./recording_reader";
import { RecordingWriter } from "./recording_writer";

/** The thread that writes and reads recordings. It is started when it is needed, and carries out one request. */

interface Port {
  postMessage(message: FromArchive, transfer?: Transferable[]): void;
  onmessage: ((event: MessageEvent<ToArchive>) => void) | null;
}
const connection = globalThis as unknown as Port;

async function carryOut(request: ToArchive): Promise<void> {
  if (request.kind === "write") {
    const writer = new RecordingWriter(request.welcome);
    for (const segment of request.segments) writer.add(segment);
    if (writer.frames === 0) throw new Error("there are no frames with spheres");
    writer.finish();
    return connection.postMessage({ kind: "written", file: new Blob(writer.parts), frames: writer.frames });
  }
  if (request.file.size > mostBytes) throw new Error("is larger than 1 GiB: play it with spherule play");
  const buffer = await request.file.arrayBuffer();
  connection.postMessage({ kind: "read", content: readRecording(new Uint8Array(buffer)) }, [buffer]);
}

const mostBytes = 2 ** 30;

connection.onmessage = ({ data }) => {
  carryOut(data).catch((error: unknown) => {
    connection.postMessage({ kind: "failed", reason: error instanceof Error ? error.message : String(error) });
  });
};
