import { fromBinary } from "@bufbuild/protobuf";
import type { RecordingContent } from "../connection/archive_messages";
import { BufferPool } from "../connection/buffer_pool";
import { Frames } from "../connection/frames";
import type { FramesState } from "../connection/frames";
import type { Segment } from "../connection/history";
import { idsOf } from "../connection/order";
import { periodsOf } from "../connection/periods";
import { decode } from "../connection/protocol";
import { ServerMessageSchema } from "../gen/spherule/v1/control_pb";
import type { ServerMessage, Settings, Welcome } from "../gen/spherule/v1/control_pb";
import type { SceneFacts } from "../gen/spherule/v1/facts_pb";
import { checksumBytes, checksumOf, endMagic, entryBytes, fileMagic, headBytes, indexHeadBytes } from "./format";
import { isKnown, Kind, mostPayload, newestVersion, oldestVersion, recordHeadBytes } from "./format";
import { textAt, trailerBytes, viewOf } from "./format";
import type { FileHead } from "./format";

const mostDamage = 20; // reports

interface Record {
  kind: number;
  time: number; // s
  payload: Uint8Array;
  end: number; // byte after the record
}

/** Reads a recording for playback. Throws an Error that says what is wrong, and where, if nothing can be played. */
export function readRecording(bytes: Uint8Array): RecordingContent {
  const reader = new RecordingReader(bytes, headOf(bytes));
  reader.read();
  const { segments, settings, source, end, flaw, damage } = reader;
  const [first] = segments;
  if (!first) throw new Error(`has no frames${flaw && `: ${flaw}`}`);
  checkFirst(first);
  return { segments, settings, source, end, flaw, damage };
}

function headOf(bytes: Uint8Array): FileHead {
  if (textAt(bytes, 0, fileMagic.length) !== fileMagic) throw new Error("is no recording: it does not begin like one");
  if (bytes.byteLength < headBytes) throw new Error(`is no recording: it has only ${bytes.byteLength} bytes`);
  const version = viewOf(bytes).getUint32(8, true);
  const id = viewOf(bytes).getUint32(12, true);
  if (version > newestVersion) {
    const read = `versions ${oldestVersion} and ${newestVersion}`;
    throw new Error(`is of version ${version} of the format; this page reads ${read}: use a newer spherule`);
  }
  if (version < oldestVersion || (version === 1 && id !== 0)) throw new Error("is no recording: its head is damaged");
  return { version, id };
}

class RecordingReader {
  readonly segments: Segment[] = [];
  settings: Settings | undefined; // the first ones
  source: Welcome | undefined;
  end = 0;
  flaw = "";
  readonly damage: string[] = [];
  private now: Settings | undefined;
  private facts: SceneFacts | undefined;
  private start: FramesState | undefined; // of chains; undefined: no order of the present scene has come
  private origin = 0;
  private segment: Segment | undefined; // to which the next delta frame belongs
  private resync: Uint8Array | undefined; // newest; the next delta frame begins a segment
  private readonly view: DataView;
  private readonly begins: number[]; // offsets of keyframes in the index, if there is one
  private readonly last: number; // byte after the last record

  constructor(
    private readonly bytes: Uint8Array,
    private readonly head: FileHead,
  ) {
    this.view = viewOf(bytes);
    const index = this.indexOffset();
    this.last = index ?? bytes.byteLength;
    this.begins = index === undefined ? [] : this.keyframesOf(index);
    if (index === undefined) this.flaw = "it was not finished";
  }

  read(): void {
    let at = headBytes;
    let time = -Infinity;
    while (at < this.last) {
      try {
        const record = this.recordAt(at);
        if (record.kind === Kind.index || record.time < time) throw new Error(`the record at byte ${at} is misplaced`);
        this.take(record);
        time = record.time;
        at = record.end;
      } catch (error) {
        const next = this.begins.find((offset) => offset > at);
        this.report(error, next);
        if (next === undefined) return;
        this.segment = this.resync = undefined;
        at = next;
      }
    }
  }

  private report(error: unknown, next: number | undefined): void {
    const reason = error instanceof Error ? error.message : String(error);
    if (next === undefined) this.flaw = reason;
    else if (this.damage.length < mostDamage) this.damage.push(reason);
  }

  /** The place of the index; undefined if the recording was not finished. */
  private indexOffset(): number | undefined {
    const { bytes, view } = this;
    const at = bytes.byteLength - trailerBytes;
    if (at < headBytes || textAt(bytes, at + 8, endMagic.length) !== endMagic) return undefined;
    const offset = Number(view.getBigUint64(at, true));
    if (offset < headBytes || offset > at) return undefined;
    try {
      const { kind, end } = this.recordAt(offset);
      return kind === Kind.index && end === at ? offset : undefined;
    } catch {
      return undefined;
    }
  }

  private keyframesOf(index: number): number[] {
    const { payload } = this.recordAt(index);
    const view = viewOf(payload);
    const offsets: number[] = [];
    for (let at = indexHeadBytes; at + entryBytes <= payload.byteLength; at += entryBytes) {
      const kind = view.getUint32(at + 16, true);
      const offset = Number(view.getBigUint64(at, true));
      if ([Kind.keyframe, Kind.resync, Kind.scene].includes(kind as 1) && offset < index) offsets.push(offset);
    }
    return offsets;
  }

  private recordAt(at: number): Record {
    const { bytes, view } = this;
    const bad = (what: string): Error => new Error(`the record at byte ${at} ${what}`);
    if (at + recordHeadBytes > bytes.byteLength) throw bad("is cut off");
    const length = view.getUint32(at, true);
    const kind = view.getUint32(at + 4, true);
    const time = view.getFloat64(at + 8, true);
    const hashed = at + recordHeadBytes + length;
    if (length > mostPayload) throw bad("is damaged: it is too long");
    if (hashed + checksumBytes > bytes.byteLength) throw bad("is cut off");
    if (!isKnown(kind, this.head.version) || !Number.isFinite(time)) throw bad("is damaged: its head is invalid");
    if (view.getBigUint64(hashed, true) !== checksumOf(bytes.subarray(at, hashed), this.head, at)) {
      throw bad("is damaged: its checksum differs");
    }
    return { kind, time, payload: bytes.subarray(at + recordHeadBytes, hashed), end: hashed + checksumBytes };
  }

  /** Playback does not need logs. Their checksums count: one changed bit makes a log of a scene. */
  private take({ kind, time, payload }: Record): void {
    const begins = kind === Kind.keyframe || (kind === Kind.resync && !this.segment);
    if (begins) this.open(time, undefined);
    else if (kind === Kind.resync) this.resync = payload;
    else if (kind === Kind.delta && this.resync) this.open(time, this.resync);
    if (begins || (kind === Kind.delta && this.segment)) this.addFrame(time, payload);
    if (kind < Kind.keyframe) this.takeMessage(fromBinary(ServerMessageSchema, payload).kind);
  }

  private takeMessage({ case: kind, value }: ServerMessage["kind"]): void {
    if (kind === "welcome") this.source = value;
    if (kind === "settings") {
      this.settings ??= value;
      this.now = value;
    }
    if (kind === "scene") {
      this.facts = value;
      this.start = this.segment = this.resync = undefined;
      this.origin += 1;
    }
    if (kind === "order" && this.facts) {
      const { epoch, count } = this.facts;
      if (value.epoch !== epoch) throw new Error("an order is of another epoch than the scene before it");
      this.start = { epoch, count, periods: periodsOf(this.facts), order: value.number, ids: idsOf(value.ids, count) };
      this.segment = this.resync = undefined;
    }
  }

  /** Opens a segment. `prelude`: the frame before, which the segment before has, too. */
  private open(time: number, prelude: Uint8Array | undefined): void {
    const { facts, start, origin, now: settings } = this;
    if (!facts || !start) throw new Error("no scene or no order comes before a frame");
    const counts = { number: this.segments.length, frames: 0, startBytes: 0, frameBytes: 0 };
    const joins = prelude !== undefined;
    this.segment = { ...counts, origin, scene: facts, start, prelude, settings, joins, begin: time, entries: [] };
    this.resync = undefined;
    this.segments.push(this.segment);
  }

  private addFrame(time: number, message: Uint8Array): void {
    this.segment?.entries.push({ kind: "frame", at: time, simTime: time, message });
    this.end = time;
  }
}

/** Throws an Error if the frame with which playback begins cannot be decoded. */
function checkFirst({ start, entries }: Segment): void {
  const frames = new Frames(new BufferPool());
  frames.restore(start);
  const [entry] = entries;
  const message = entry?.kind === "frame" ? decode(entry.message) : undefined;
  if (message?.case !== "frame") throw new Error("is damaged: its first frame is no frame");
  const { kind } = frames.decode(message.value, false);
  if (kind !== "state") throw new Error("is damaged: its first frame is of other spheres than the scene before it");
}
