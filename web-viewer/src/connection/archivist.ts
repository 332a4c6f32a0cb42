import type { FromArchive, ToArchive } from "./archive_messages";

type Answer<Kind> = Extract<FromArchive, { kind: Kind }>;

/** Has a recording written or read by a thread of its own, which is loaded for that. */
export function askArchive<Kind extends "written" | "read">(request: ToArchive, kind: Kind): Promise<Answer<Kind>> {
  return new Promise((resolve, reject) => {
    const worker = new Worker("archive.js");
    const settle = (action: () => void): void => {
      worker.terminate();
      action();
    };
    worker.onmessage = ({ data }: MessageEvent<FromArchive>) => {
      if (data.kind === "failed") settle(() => reject(new Error(data.reason)));
      else if (data.kind === kind) settle(() => resolve(data as Answer<Kind>));
    };
    worker.onerror = ({ message }) => settle(() => reject(new Error(message || "archive.js cannot be loaded")));
    worker.postMessage(request);
  });
}
