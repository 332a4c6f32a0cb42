import type { Settings } from "../gen/spherule/v1/control_pb";
import type { Population, SceneFacts } from "../gen/spherule/v1/facts_pb";
import type { Frame } from "../gen/spherule/v1/frame_pb";
import type { Frames, FramesState } from "./frames";
import { History } from "./history";
import { PlaceTable } from "./place_table";

export const lookBackSeconds = 30;
const lookBackBytes = 128 * 2 ** 20;
const longestGap = 0.5; // s of the track between two frames: a pause of the world takes no more
const segmentSeconds = 2; // least duration of a segment
const longSegmentSeconds = 10;
const smallShare = 1 / 4; // a segment goes on while its frames take less than this share of the bytes of a state
const mostShare = 1 / 4; // of all bytes that the frames of a segment take

/** Keeps the last half minute of a live simulation, as it was received. */
export class LookBack {
  readonly history = new History();
  settings: Settings | undefined; // of the simulation
  private table: PlaceTable | undefined; // of the newest facts and population; undefined: none have come
  private scene: SceneFacts | undefined;
  private origin = 0;
  private renewed = false; // facts have come that no segment has yet
  private follows = false; // the last segment ends with the frame that was decoded last
  private readyBefore = 0; // ms, of the frame before
  private next: FramesState | undefined; // from which the next frame can be decoded: it can begin a segment
  private keptFrom: number | undefined; // time from which on nothing is dropped, except for want of room

  /** `mostBytes`: of frames and states. */
  constructor(private readonly mostBytes = lookBackBytes) {}

  /** Call when a connection has been made: the next frames do not continue the present ones. */
  connected(): void {
    this.scene = undefined;
  }

  clear(): void {
    this.history.clear();
    this.table = this.next = this.scene = undefined;
    this.follows = false;
  }

  /** The present facts, for a page that has shown others. */
  get facts(): SceneFacts | undefined {
    return this.table?.facts();
  }

  /** Keeps all from the present begin on, or ends that. */
  keep(kept: boolean): void {
    this.keptFrom = kept ? (this.keptFrom ?? this.begin) : undefined;
  }

  /** Begin of the track (s). */
  get begin(): number {
    const { history, keptFrom } = this;
    return Math.max(history.begin, keptFrom ?? history.end - lookBackSeconds);
  }

  sceneReceived(facts: SceneFacts): void {
    if (this.scene?.epoch !== facts.epoch) {
      this.origin += 1;
      this.follows = false;
    }
    this.scene = facts;
    this.table = new PlaceTable(facts);
    this.renewed = true;
  }

  populationReceived(change: Population): void {
    const { table } = this;
    if (!table || change.epoch !== this.scene?.epoch || change.number !== table.number + 1) return;
    table.apply(change);
    if (!this.renewed) this.history.add({ kind: "population", change });
  }

  /** Call when a frame has been decoded. `message`: that had it; `frames`: that decoded it. */
  frameDecoded(frame: Frame, message: Uint8Array, keyframe: boolean, frames: Frames): void {
    const { history, table } = this;
    if (!table || frame.population > table.number) return;
    const at = history.end + this.gapBefore(frame);
    const described = frame.population === table.number; // the table tells the spheres of this frame
    const start = keyframe ? frames.save(false) : this.next;
    if (keyframe) this.follows = false;
    if (described && start && (keyframe || this.isDue(at))) {
      const { origin, settings, follows: joins } = this;
      history.open({ origin, scene: table.facts(), start, settings, joins }, at);
      this.follows = true;
      this.renewed = false;
    }
    if (this.follows) history.add({ kind: "frame", at, simTime: frame.simTime, message });
    this.next = this.isDue(at + longestGap) && this.hasRoom ? frames.save(true) : undefined;
    this.trim();
  }

  /** Time on the track since the frame before (s). */
  private gapBefore({ stampUs }: Frame): number {
    const ready = Number(stampUs) / 1000;
    const gap = (ready - this.readyBefore) / 1000;
    this.readyBefore = ready;
    return Math.min(longestGap, Math.max(0.001, gap));
  }

  /** Whether a frame at this time should begin a segment. */
  private isDue(at: number): boolean {
    const { last } = this.history;
    if (!last || !this.follows || this.renewed) return true;
    const age = at - last.begin;
    if (last.frameBytes >= mostShare * this.mostBytes) return true;
    if (age < segmentSeconds) return false;
    return age >= longSegmentSeconds || last.frameBytes >= smallShare * this.stateBytes;
  }

  /** The least bytes of a saved state. */
  private get stateBytes(): number {
    return 2 * 3 * Int32Array.BYTES_PER_ELEMENT * (this.scene?.count ?? 0);
  }

  private get hasRoom(): boolean {
    return this.stateBytes <= this.mostBytes / 4;
  }

  private trim(): void {
    const { history, keptFrom } = this;
    const from = keptFrom ?? history.end - lookBackSeconds;
    for (;;) {
      const [first, second] = history.all;
      const old = first && second && second.begin <= from;
      if (!first || (!old && history.bytes <= this.mostBytes)) return;
      history.dropFirst();
      if (!second) this.follows = false;
    }
  }
}
