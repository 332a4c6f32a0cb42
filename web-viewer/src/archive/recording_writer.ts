import { create, toBinary } from "@bufbuild/protobuf";
import { Encoder } from "../codec/encoder";
import { BufferPool } from "../connection/buffer_pool";
import { Frames } from "../connection/frames";
import type { PastFrame, Segment } from "../connection/history";
import { PlaceTable } from "../connection/place_table";
import { decode } from "../connection/protocol";
import { ServerMessageSchema } from "../gen/spherule/v1/control_pb";
import type { ServerMessage, Settings, Welcome } from "../gen/spherule/v1/control_pb";
import type { Population } from "../gen/spherule/v1/facts_pb";
import { FrameSchema, OrderSchema } from "../gen/spherule/v1/frame_pb";
import type { Frame } from "../gen/spherule/v1/frame_pb";
import { WelcomeSchema } from "../gen/spherule/v1/control_pb";
import { fileOf, headBytes, indexOf, Kind, newestVersion, recordOf, trailerOf } from "./format";
import type { FileHead, IndexEntry } from "./format";
import { spheresOf } from "./spheres";
import type { Spheres } from "./spheres";

const resyncEvery = 2; // s
const hashEvery = 1; // s

/**
 * Writes the frames of a history as a recording. Recordings have no places and no changes of the population, so the
 * frames are encoded again, of the spheres alone. Positions stay the same, bit by bit.
 */
export class RecordingWriter {
  frames = 0;
  private readonly head: FileHead = { version: newestVersion, id: Math.floor(Math.random() * 2 ** 32) };
  readonly parts: Uint8Array<ArrayBuffer>[] = [fileOf(this.head)];
  private length = headBytes;
  private readonly index: IndexEntry[] = [];
  private readonly decoder = new Frames(new BufferPool());
  private table: PlaceTable | undefined;
  private pending: Population[] = [];
  private ids: Uint32Array | undefined; // the order of the places
  private spheres: Spheres | undefined; // of the newest population
  private epoch = 0;
  private encoder = new Encoder(1);
  private grid = ""; // of the newest frame
  private begin = 0; // s: times in the file
  private time = 0;
  private offset = 0; // s: of times in the file to simulated times
  private simTime: number | undefined; // s, of the newest frame
  private hashed = -Infinity; // s: when the newest frame with a hash was written
  private synced = 0; // s: when decoding could begin last
  private settings: Settings | undefined;

  constructor(private readonly welcome: Welcome | undefined) {}

  add(segment: Segment): void {
    if (!segment.joins || !this.table) {
      this.decoder.restore(segment.start);
      this.table = new PlaceTable(segment.scene);
      this.pending = [];
    }
    if (!segment.joins || segment.start.ids !== this.ids) this.spheres = undefined;
    this.ids = segment.start.ids;
    for (const entry of segment.entries) {
      if (entry.kind === "population") this.pending.push(entry.change);
      else this.addFrame(entry, segment);
    }
  }

  /** Call after the last segment. */
  finish(): void {
    const at = this.length;
    const index = indexOf(this.frames, this.begin, this.time, this.index);
    this.append(recordOf(Kind.index, this.time, index, this.head, at));
    this.append(trailerOf(at));
  }

  private addFrame({ message }: PastFrame, segment: Segment): void {
    const { case: kind, value: frame } = decode(message);
    if (kind !== "frame" || this.decoder.decode(frame, false).kind !== "state") return;
    this.follow(frame.population);
    if (this.standsStill(frame)) return;
    const fresh = this.spheres === undefined;
    this.spheres ??= this.table && spheresOf(this.table.facts(), segment.start.ids);
    if (!this.spheres) return; // recordings cannot have frames without spheres
    this.setTime(frame.simTime);
    if (fresh) this.beginSpheres(this.spheres, segment.settings);
    this.setSettings(segment.settings);
    this.writeFrame(frame, this.spheres);
  }

  private follow(population: number): void {
    while (this.pending[0] && this.pending[0].number <= population) {
      this.table?.apply(this.pending.shift() as Population);
      this.spheres = undefined;
    }
  }

  /** A paused world adds nothing. */
  private standsStill({ simTime, status }: Frame): boolean {
    return simTime === this.simTime || (status?.paused === true && simTime + this.offset <= this.time);
  }

  /** Time continues where a reset or another scene sets the simulated time back. */
  private setTime(simTime: number): void {
    if (this.frames === 0) this.begin = this.time = simTime;
    this.simTime = simTime;
    if (simTime + this.offset < this.time) this.offset = this.time - simTime;
    this.time = Math.max(this.time, simTime + this.offset);
  }

  private beginSpheres({ facts, order }: Spheres, settings: Settings | undefined): void {
    if (this.frames === 0) {
      const { server = "", device = "", renderer = "", reason = "" } = this.welcome ?? {};
      this.write(Kind.other, { case: "welcome", value: create(WelcomeSchema, { server, device, renderer, reason }) });
    }
    this.epoch += 1;
    this.write(Kind.scene, { case: "scene", value: { ...facts, epoch: this.epoch } });
    const ids = create(OrderSchema, { epoch: this.epoch, number: 1, ids: order });
    this.write(Kind.order, { case: "order", value: ids });
    if (this.frames === 0) this.setSettings(settings);
    this.encoder = new Encoder(facts.count);
  }

  private setSettings(settings: Settings | undefined): void {
    if (!settings || settings === this.settings) return;
    this.settings = settings;
    this.write(Kind.settings, { case: "settings", value: settings });
  }

  private writeFrame(frame: Frame, { chosen, facts }: Spheres): void {
    const { newest, turns, quantum } = this.decoder.grid;
    const grid = `${this.epoch} ${frame.tier} ${quantum}`;
    if (grid !== this.grid) this.encoder = new Encoder(facts.count); // a chain has one quantum
    this.grid = grid;
    const positions = new Int32Array(3 * chosen.length);
    chosen.forEach((from, to) => {
      positions[3 * to] = newest[3 * from] as number;
      positions[3 * to + 1] = newest[3 * from + 1] as number;
      positions[3 * to + 2] = newest[3 * from + 2] as number;
    });
    const hashed = this.time - this.hashed >= hashEvery;
    if (hashed) this.hashed = this.time;
    const { spb, keyframe } = this.encoder.encode(positions, turns, hashed);
    const { step, simTime, status, tier, stampUs, poses } = frame;
    const head = { sequence: BigInt(this.frames + 1), epoch: this.epoch, order: 1, count: facts.count, quantum };
    const written = create(FrameSchema, { ...head, step, simTime, status, tier, stampUs, poses, spb });
    this.write(keyframe ? Kind.keyframe : Kind.delta, { case: "frame", value: written });
    this.frames += 1;
    if (keyframe) this.synced = this.time;
    if (this.time - this.synced < resyncEvery) return;
    this.synced = this.time;
    this.write(Kind.resync, { case: "frame", value: { ...written, spb: this.encoder.resync() } });
  }

  private write(kind: number, message: ServerMessage["kind"]): void {
    const indexed = kind !== Kind.other && kind !== Kind.delta;
    if (indexed) this.index.push({ offset: this.length, time: this.time, kind });
    const payload = toBinary(ServerMessageSchema, create(ServerMessageSchema, { kind: message }));
    this.append(recordOf(kind, this.time, payload, this.head, this.length));
  }

  private append(bytes: Uint8Array<ArrayBuffer>): void {
    this.parts.push(bytes);
    this.length += bytes.byteLength;
  }
}
