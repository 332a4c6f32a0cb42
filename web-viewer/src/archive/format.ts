import { xxh3 } from "./xxh3";

/** The container of recordings, after docs/recordings.md. All numbers are little endian. */

export const Kind = {
  scene: 1,
  order: 2,
  settings: 3,
  other: 4,
  keyframe: 5,
  resync: 6,
  delta: 7,
  index: 8,
  log: 9, // since version 2
} as const;

export const headBytes = 16; // of the file
export const recordHeadBytes = 16;
export const checksumBytes = 8;
export const mostPayload = 2 ** 30; // bytes
export const indexHeadBytes = 24;
export const entryBytes = 24; // of the index
export const trailerBytes = 16;
export const newestVersion = 2; // written
export const oldestVersion = 1; // read, as all versions up to the newest
export const fileMagic = "SPHREC\r\n";
export const endMagic = "SPHEND\r\n";

/** True for the kinds above that this version of the format has. */
export function isKnown(kind: number, version: number): boolean {
  return kind >= Kind.scene && kind <= (version === 1 ? Kind.index : Kind.log);
}

/** The head of a file. */
export interface FileHead {
  version: number;
  id: number; // 32 bits, tells recordings apart: checksums are of it; 0 in version 1
}

/** A record of which the index tells the place. */
export interface IndexEntry {
  offset: number;
  time: number; // s
  kind: number;
}

export function textAt(bytes: Uint8Array, at: number, length: number): string {
  return String.fromCharCode(...bytes.subarray(at, at + length));
}

export function viewOf(bytes: Uint8Array): DataView {
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}

/** A file without records. */
export function fileOf({ version, id }: FileHead): Uint8Array<ArrayBuffer> {
  const head = new Uint8Array(headBytes);
  head.set(asciiOf(fileMagic));
  viewOf(head).setUint32(8, version, true);
  viewOf(head).setUint32(12, id, true);
  return head;
}

/**
 * The checksum of a record, of which `record` has the head and the payload. `offset`: of the record in the file. In
 * version 1 a record has the same checksum at each place of each file.
 */
export function checksumOf(record: Uint8Array, { version, id }: FileHead, offset: number): bigint {
  const own = xxh3(record);
  if (version === 1) return own;
  const placed = new DataView(new ArrayBuffer(20));
  placed.setBigUint64(0, own, true);
  placed.setBigUint64(8, BigInt(offset), true);
  placed.setUint32(16, id, true);
  return xxh3(new Uint8Array(placed.buffer));
}

/** A record with head and checksum, as at `offset` of the file. */
export function recordOf(
  kind: number,
  time: number,
  payload: Uint8Array,
  file: FileHead,
  offset: number,
): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(recordHeadBytes + payload.byteLength + checksumBytes);
  const view = viewOf(bytes);
  view.setUint32(0, payload.byteLength, true);
  view.setUint32(4, kind, true);
  view.setFloat64(8, time, true);
  bytes.set(payload, recordHeadBytes);
  const hashed = bytes.byteLength - checksumBytes;
  view.setBigUint64(hashed, checksumOf(bytes.subarray(0, hashed), file, offset), true);
  return bytes;
}

export function indexOf(
  frames: number,
  begin: number,
  end: number,
  entries: readonly IndexEntry[],
): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(indexHeadBytes + entryBytes * entries.length);
  const view = viewOf(bytes);
  view.setBigUint64(0, BigInt(frames), true);
  view.setFloat64(8, begin, true);
  view.setFloat64(16, end, true);
  entries.forEach(({ offset, time, kind }, k) => {
    const at = indexHeadBytes + entryBytes * k;
    view.setBigUint64(at, BigInt(offset), true);
    view.setFloat64(at + 8, time, true);
    view.setUint32(at + 16, kind, true);
  });
  return bytes;
}

/** `offset`: of the index. */
export function trailerOf(offset: number): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(trailerBytes);
  viewOf(bytes).setBigUint64(0, BigInt(offset), true);
  bytes.set(asciiOf(endMagic), 8);
  return bytes;
}

function asciiOf(text: string): Uint8Array {
  return Uint8Array.from(text, (letter) => letter.charCodeAt(0));
}
