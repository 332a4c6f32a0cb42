import type { Settings } from "../gen/spherule/v1/control_pb";
import type { Population, SceneFacts } from "../gen/spherule/v1/facts_pb";
import type { FramesState } from "./frames";

/** Encoded frames of the past, in the order in which they are shown. Times on the track are in s. */

export interface PastFrame {
  kind: "frame";
  at: number; // time on the track
  simTime: number; // s
  message: Uint8Array; // a ServerMessage with the frame
}

export type Entry = PastFrame | { kind: "population"; change: Population };

/** Consecutive entries, of which the first frame can be decoded from `start`. */
export interface Segment {
  number: number; // counts segments
  origin: number; // segments with equal numbers are of one epoch of one connection
  scene: SceneFacts; // with the population of the first frame
  start: FramesState;
  prelude?: Uint8Array; // a message with the frame before the first one, which is decoded after `start`
  settings: Settings | undefined; // at the begin
  joins: boolean; // its first frame follows the last frame of the segment before
  begin: number; // time of the first frame
  entries: Entry[];
  frames: number;
  startBytes: number; // of all but the frames
  frameBytes: number;
}

/** A frame of a segment. */
export interface Place {
  segment: Segment;
  index: number; // of the entry
}

/** The beginning of a segment. */
export type SegmentStart = Pick<Segment, "origin" | "scene" | "start" | "prelude" | "settings" | "joins">;

export class History {
  private segments: Segment[] = [];
  private count = 0; // segments so far
  bytes = 0;
  frames = 0;
  end = 0; // time of the last frame

  get all(): readonly Segment[] {
    return this.segments;
  }

  get begin(): number {
    return this.segments[0]?.begin ?? this.end;
  }

  get last(): Segment | undefined {
    return this.segments.at(-1);
  }

  clear(): void {
    while (this.segments.length > 0) this.dropFirst();
  }

  open(start: SegmentStart, at: number): void {
    const startBytes = bytesOf(start);
    const empty = { entries: [], frames: 0, startBytes, frameBytes: 0 };
    this.segments.push({ ...start, ...empty, number: this.count++, begin: at });
    this.bytes += startBytes;
  }

  /** Adds an entry to the last segment. */
  add(entry: Entry): void {
    const { last } = this;
    if (!last) return;
    last.entries.push(entry);
    if (entry.kind !== "frame") return;
    last.frames += 1;
    last.frameBytes += entry.message.byteLength;
    this.frames += 1;
    this.bytes += entry.message.byteLength;
    this.end = entry.at;
  }

  dropFirst(): void {
    const first = this.segments.shift();
    if (!first) return;
    this.bytes -= first.startBytes + first.frameBytes;
    this.frames -= first.frames;
  }

  /** The segment after this one, or the first one if this one was dropped. */
  after({ number }: Segment): Segment | undefined {
    const first = this.segments[0]?.number ?? 0;
    return this.segments[Math.max(0, number + 1 - first)];
  }

  has(segment: Segment): boolean {
    return segment.number >= (this.segments[0]?.number ?? Infinity);
  }

  /** The last frame that is not after `time`, or the first frame; undefined if there is no frame. */
  find(time: number): Place | undefined {
    const { segments } = this;
    let [low, high] = [0, segments.length];
    while (high - low > 1) {
      const middle = (low + high) >>> 1;
      if ((segments[middle] as Segment).begin <= time) low = middle;
      else high = middle;
    }
    const segment = segments[low];
    if (!segment) return undefined;
    const first = segment.entries.findIndex(({ kind }) => kind === "frame");
    let index = segment.entries.length - 1;
    for (; index > first; index--) {
      const entry = segment.entries[index] as Entry;
      if (entry.kind === "frame" && entry.at <= time) break;
    }
    return { segment, index: Math.max(first, index) };
  }
}

function bytesOf({ scene, start }: SegmentStart): number {
  const grids = start.chain?.states.map(([, { newest, before }]) => newest.byteLength + before.byteLength) ?? [];
  return grids.reduce((sum, bytes) => sum + bytes, scene.radii.byteLength + 64 * scene.places.length);
}
