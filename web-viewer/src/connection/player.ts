import type { Population, SceneFacts } from "../gen/spherule/v1/facts_pb";
import type { Frame } from "../gen/spherule/v1/frame_pb";
import { sharedNow } from "../clock";
import type { BufferPool } from "./buffer_pool";
import { Frames } from "./frames";
import type { Entry, History, PastFrame, Place, Segment } from "./history";
import type { Received } from "./messages";
import { decode } from "./protocol";
import { received } from "./stream";

export interface PlayerEvents {
  /** Frames of this scene follow, whatever came before. */
  scene(facts: SceneFacts): void;
  population(change: Population): void;
  /** `frames`: that decoded it. */
  frame(frame: Received, frames: Frames): void;
  /** There is no further frame. */
  ended(): void;
  /** A frame cannot be decoded; the player goes on behind it. */
  damaged(reason: string): void;
}

const early = 1e-6; // s; tolerance of timers

let shownFrames = 0; // of all players: gives each a number of its own

/** Plays frames of the past, at their times. */
export class Player {
  paused = false;
  private speed = 1;
  private readonly frames: Frames;
  private segment: Segment | undefined; // of the frame that is shown
  private next = 0; // index of the entry after it
  private clock = { wall: 0, at: 0 }; // ms and s: a moment, and its time on the track
  private told = { origin: -1, population: -1 }; // of the newest scene event
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `simulated`: the simulated times of frames are their times on the track. */
  constructor(
    private readonly history: History,
    private readonly simulated: boolean,
    buffers: BufferPool,
    private readonly events: PlayerEvents,
  ) {
    this.frames = new Frames(buffers);
  }

  stop(): void {
    clearTimeout(this.timer);
  }

  pause(): void {
    this.clock = { wall: sharedNow(), at: this.now };
    this.paused = true;
    this.stop();
  }

  resume(): void {
    this.clock.wall = sharedNow();
    this.paused = false;
    this.plan();
  }

  setSpeed(speed: number): void {
    this.clock = { wall: sharedNow(), at: this.now };
    this.speed = speed;
    this.plan();
  }

  /** Shows the last frame that is not after `time`, and goes on from there. */
  seek(time: number): void {
    const at = Math.min(Math.max(time, this.history.begin), this.history.end);
    this.clock = { wall: sharedNow(), at };
    this.show(this.history.find(at));
    this.plan();
  }

  /** Shows the frame that comes `count` frames later, or the last one, and pauses. */
  step(count: number): void {
    this.pause();
    let place: Place | undefined;
    for (let k = 0; k < count; k++) place = this.frameAfter(place) ?? place;
    if (!place) return;
    this.clock.at = frameAt(place).at;
    this.show(place);
  }

  get atEnd(): boolean {
    return this.frameAfter(undefined) === undefined;
  }

  /** The time that is due on the track (s). */
  private get now(): number {
    const { wall, at } = this.clock;
    return this.paused ? at : Math.min(this.history.end, at + (this.speed * (sharedNow() - wall)) / 1000);
  }

  private plan(): void {
    this.stop();
    if (this.paused) return;
    const place = this.frameAfter(undefined);
    if (!place) return this.events.ended();
    const wait = (1000 * (frameAt(place).at - this.now)) / this.speed;
    this.timer = setTimeout(() => this.advance(), Math.max(0, wait));
  }

  private advance(): void {
    const due = this.history.find(this.now + early);
    this.show(due && this.isBehind(due) ? due : this.frameAfter(undefined));
    this.plan();
  }

  /** Whether the place comes after the frame that is shown. */
  private isBehind({ segment, index }: Place): boolean {
    const { number } = this.segment ?? { number: -1 };
    return segment.number > number || (segment.number === number && index >= this.next);
  }

  /** The frame after a place, or after the one that is shown; undefined if there is none. */
  private frameAfter(place: Place | undefined): Place | undefined {
    let segment = place?.segment ?? this.segment;
    if (segment && !this.history.has(segment)) return this.history.find(-Infinity);
    let index = place ? place.index + 1 : this.next;
    while (segment) {
      for (; index < segment.entries.length; index++) {
        if (segment.entries[index]?.kind === "frame") return { segment, index };
      }
      segment = this.history.after(segment);
      index = 0;
    }
    return undefined;
  }

  /** Decodes up to the frame, and shows it. Instead of a damaged frame, shows the first one that can be decoded. */
  private show(place: Place | undefined): void {
    let wanted = place;
    while (wanted && wanted.index >= 0) {
      const damaged = this.run(wanted);
      if (!damaged) return;
      this.next = damaged.entries.length;
      wanted = this.firstFrame(this.history.after(damaged));
      if (wanted) this.segment = undefined; // so that decoding begins again
    }
  }

  /** Frames up to the wanted one are decoded only. Returns the segment that has a damaged frame, if one has. */
  private run(wanted: Place): Segment | undefined {
    if (!this.leadsTo(wanted) && !this.begin(wanted.segment)) return wanted.segment;
    while (this.segment) {
      const { segment } = this;
      while (this.next < segment.entries.length) {
        const last = segment === wanted.segment && this.next === wanted.index;
        if (!this.carryOut(segment.entries[this.next++] as Entry, last)) return segment;
        if (last) return undefined;
      }
      const after = this.history.after(segment);
      if (!after) return undefined;
      if (after.joins) this.enter(after);
      else if (!this.begin(after)) return after;
    }
    return undefined;
  }

  /** Whether the frame can be reached from the one that is shown without a jump. */
  private leadsTo({ segment, index }: Place): boolean {
    let from = this.segment;
    if (!from || !this.history.has(from)) return false;
    if (from === segment) return index >= this.next;
    while (from.number < segment.number) {
      from = this.history.after(from);
      if (!from?.joins) return false;
    }
    // A segment that is far away begins faster.
    return segment.number === (this.segment?.number ?? 0) + 1;
  }

  /** Returns false if the segment cannot be decoded. */
  private begin(segment: Segment): boolean {
    this.frames.restore(segment.start);
    this.enter(segment);
    const { prelude } = segment;
    return !prelude || this.succeeds(() => void this.frames.decode(frameIn(prelude), false));
  }

  private enter(segment: Segment): void {
    this.segment = segment;
    this.next = 0;
    const { origin, scene } = segment;
    if (origin === this.told.origin && scene.population === this.told.population) return;
    this.told = { origin, population: scene.population };
    this.events.scene(scene);
  }

  /** Returns false if the entry is a damaged frame. */
  private carryOut(entry: Entry, shown: boolean): boolean {
    if (entry.kind === "population") {
      this.told.population = entry.change.number;
      this.events.population(entry.change);
      return true;
    }
    return this.succeeds(() => this.decode(entry, shown));
  }

  private succeeds(action: () => void): boolean {
    try {
      action();
      return true;
    } catch (error) {
      this.events.damaged(error instanceof Error ? error.message : String(error));
      return false;
    }
  }

  private decode({ at, message }: PastFrame, shown: boolean): void {
    const start = performance.now();
    const frame = frameIn(message);
    const decoded = this.frames.decode(frame, shown);
    if (decoded.kind !== "state") throw new Error(`frame ${frame.sequence}: does not follow the frame before`);
    if (!shown) return;
    const cost = { arrival: sharedNow(), bytes: message.byteLength, decodeMs: performance.now() - start };
    const state = received(frame, decoded.content, cost);
    const simTime = this.simulated ? at : state.simTime;
    this.events.frame({ ...state, simTime, at, ready: 0, sequence: -++shownFrames }, this.frames);
  }

  private firstFrame(segment: Segment | undefined): Place | undefined {
    return segment && { segment, index: segment.entries.findIndex(({ kind }) => kind === "frame") };
  }
}

function frameIn(message: Uint8Array): Frame {
  const { case: kind, value } = decode(message);
  if (kind !== "frame") throw new Error("a message is no frame");
  return value;
}

function frameAt({ segment, index }: Place): PastFrame {
  return segment.entries[index] as PastFrame;
}
