import { create, toBinary } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { BufferPool } from "../src/connection/buffer_pool";
import { Frames } from "../src/connection/frames";
import { LookBack, lookBackSeconds } from "../src/connection/look_back";
import type { Received } from "../src/connection/messages";
import { Player } from "../src/connection/player";
import { ServerMessageSchema } from "../src/gen/spherule/v1/control_pb";
import { PlacesSchema, PopulationSchema, SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import type { SceneFacts } from "../src/gen/spherule/v1/facts_pb";
import { frameOf, keyframe, moved, orderOf } from "./support/chain";

type Shown = { x: number; simTime: number; at: number; population: number };

const spacing = 1 / 30; // s between two frames

/** A server whose sphere 0 and obstacle 0 are at x = k after k frames, and a page that looks back. */
class World {
  readonly lookBack: LookBack;
  readonly log: (SceneFacts | number | Shown)[] = []; // scenes, changes of the population, and frames, as played
  readonly player: Player;
  ended = 0;
  time = 0; // s
  private readonly frames = new Frames(new BufferPool());
  private epoch = 3;
  private number = 0; // of the newest frame in its chain
  private population = 0;
  private x = 0;
  private stamp = 1e6; // s

  constructor(mostBytes?: number) {
    this.lookBack = new LookBack(mostBytes);
    const faults: string[] = [];
    this.player = new Player(this.lookBack.history, false, new BufferPool(), {
      scene: (facts) => void this.log.push(facts),
      population: (change) => void this.log.push(change.number),
      frame: (frame) => void this.log.push(shownOf(frame)),
      damaged: (reason) => void faults.push(reason),
      ended: () => (this.ended += 1),
    });
    this.player.paused = true;
  }

  connect(fields: MessageInitShape<typeof SceneFactsSchema> = {}): void {
    this.lookBack.connected();
    this.load(fields);
  }

  load(fields: MessageInitShape<typeof SceneFactsSchema> = {}): void {
    this.epoch += 1;
    this.number = this.x = this.time = this.population = 0;
    const cube = { boundsMin: [-1, -1, -1], boundsMax: [1, 1, 1], radius: 0.5, count: 2 };
    const facts = create(SceneFactsSchema, { epoch: this.epoch, ...cube, ...fields });
    this.frames.setScene(this.epoch, facts.count);
    this.frames.setOrder(orderOf([0, 1], { epoch: this.epoch }));
    this.lookBack.sceneReceived(facts);
  }

  change(fields: MessageInitShape<typeof PopulationSchema>): void {
    this.population += 1;
    const message = create(PopulationSchema, { epoch: this.epoch, number: this.population, ...fields });
    this.lookBack.populationReceived(message);
  }

  /** Sends frames. `key`: the first is a keyframe. `population`: of the frames, if not the newest. */
  run(count: number, { key = this.number === 0, gap = spacing, population = this.population } = {}): void {
    for (let k = 0; k < count; k++) {
      this.x += 1;
      this.number += 1;
      this.time += spacing;
      this.stamp += gap;
      const begins = key && k === 0;
      const spb = begins
        ? keyframe(this.number, [
            [this.x, 0, 0],
            [9, 9, 9],
          ])
        : moved(this.number, 2, [1, 0, 0]);
      const times = { simTime: this.time, stampUs: BigInt(Math.round(1e6 * this.stamp)) };
      const poses = [{ translation: [this.x, 0, 0], rotation: [0, 0, 0, 1] }];
      const frame = frameOf(spb, { epoch: this.epoch, count: 2, population, quantum: 1, poses, ...times });
      const message = toBinary(
        ServerMessageSchema,
        create(ServerMessageSchema, { kind: { case: "frame", value: frame } }),
      );
      const decoded = this.frames.decode(frame);
      assert.ok(decoded.kind === "state");
      this.lookBack.frameDecoded(frame, message, decoded.keyframe, this.frames);
    }
  }

  /** What the player shows after a seek to this many seconds before the end; without what came before. */
  seek(ago: number): (SceneFacts | number | Shown)[] {
    this.log.length = 0;
    this.player.seek(this.lookBack.history.end - ago);
    return this.log;
  }
}

function shownOf({ columns, simTime, at = NaN, population, poses }: Received): Shown {
  const x = columns.position.values[0] as number;
  assert.equal(poses[0]?.translation[0], x, "a state has the poses of its frame");
  return { x, simTime, at, population };
}

/** Whether it is a frame in which sphere 0 is at x. */
const isAt = (entry: SceneFacts | number | Shown | undefined, x: number): boolean =>
  typeof entry === "object" && "x" in entry && entry.x === x;

test("any frame of the last half minute is shown as it was decoded", () => {
  const world = new World();
  world.connect();
  world.run(1500);
  for (const frames of [0, 1, 2, 17, 59, 60, 61, 400, 899]) {
    const shown = world.seek(frames * spacing - 1e-4);
    assert.ok(isAt(shown.at(-1), 1500 - frames), `${frames} frames ago`);
  }
  for (const frames of [899, 898, 800, 3]) {
    assert.ok(isAt(world.seek(frames * spacing - 1e-4).at(-1), 1500 - frames), `forward to ${frames} frames ago`);
  }
});

test("what is older than half a minute is dropped, in whole segments", () => {
  const world = new World();
  world.connect();
  world.run(3000);
  const { history, begin } = world.lookBack;
  assert.ok(Math.abs(history.end - begin - lookBackSeconds) < 1e-6);
  assert.ok(history.end - history.begin < lookBackSeconds + 11);
  assert.ok(history.all.length > 3);
  assert.equal(
    history.frames,
    history.all.reduce((sum, { entries }) => sum + entries.length, 0),
  );
});

test("while the past is shown, its begin stays", () => {
  const world = new World();
  world.connect();
  world.run(1200);
  const { begin } = world.lookBack;
  world.lookBack.keep(true);
  world.run(1200);
  assert.equal(world.lookBack.begin, begin);
  assert.ok(world.lookBack.history.begin <= begin);
  world.lookBack.keep(false);
  world.run(1);
  assert.ok(world.lookBack.history.begin > begin);
});

test("the past has no more bytes than its limit, and what it has can be shown", () => {
  const most = 20_000;
  const world = new World(most);
  world.connect();
  for (let k = 1; k <= 600; k++) {
    world.run(1);
    assert.ok(world.lookBack.history.bytes <= most, `${world.lookBack.history.bytes} bytes`);
    if (k < 100 || k % 7 > 0) continue;
    const { begin, history } = world.lookBack;
    const { end } = history;
    assert.ok(end - begin > 0.5 && end - begin < 10, `${end - begin} s`);
    world.seek(end - begin);
    const frames = Math.round((end - history.begin) / spacing);
    assert.ok(isAt(world.log.at(-1), k - frames), `after ${k} frames`);
  }
});

test("a scene whose states need too many bytes has the past since its keyframe, or none", () => {
  const world = new World(2000); // a state needs 400 bytes at least
  world.connect({ count: 2 });
  world.run(100);
  assert.ok(world.lookBack.history.bytes <= 2000);
  const tiny = new World(150);
  tiny.connect();
  tiny.run(100);
  assert.deepEqual([tiny.lookBack.history.frames, tiny.lookBack.history.all.length], [0, 0]);
});

test("a pause of the world takes no time on the track", () => {
  const world = new World();
  world.connect();
  world.run(100);
  const { end } = world.lookBack.history;
  world.run(1, { gap: 3600 });
  assert.ok(world.lookBack.history.end - end <= 0.5);
});

test("a change of the population is played where it happened, and undone by a seek before it", () => {
  const world = new World();
  world.connect({ places: [{ first: 0, count: 1, id: 0n, group: 0 }], groups: [{ name: "one" }] });
  world.run(150);
  world.change({ added: [create(PlacesSchema, { first: 1, count: 1, id: 7n, group: 1 })], groups: [{ name: "two" }] });
  world.run(2, { population: 0 }); // frames without the change may follow its message
  world.run(150);
  const [before, frame, ...rest] = world.seek(200 * spacing);
  assert.deepEqual(rest, []);
  assert.ok(typeof before === "object" && "places" in before && before.population === 0 && before.places.length === 1);
  assert.ok(isAt(frame, 102));
  assert.deepEqual(
    world.seek(199 * spacing - 1e-4).filter((entry) => typeof entry !== "object"),
    [],
  );
  const forward = world.seek(100 * spacing - 1e-4);
  assert.ok(isAt(forward.at(-1), 202));
  const known = forward.map((entry) => (typeof entry === "number" ? entry : "places" in entry ? entry.population : 0));
  assert.ok(known.includes(1), "the player tells the change, or the facts that include it");
  const last = world.seek(1);
  assert.deepEqual(last.length, 1, "nothing is told twice");
  const [again] = world.seek(290 * spacing);
  assert.ok(typeof again === "object" && "places" in again && again.population === 0);
});

test("facts at any moment tell which spheres are in which places", () => {
  const world = new World();
  world.connect({ radius: 0, radii: new Uint8Array(Float32Array.of(0.25, 0.5).buffer), groups: [{ count: 2 }] });
  world.run(1);
  world.change({ removed: [create(PlacesSchema, { first: 0, count: 1 })] });
  const radii = new Uint8Array(Float32Array.of(0.125).buffer);
  world.change({ added: [create(PlacesSchema, { first: 0, count: 1, id: 9n, group: 1, radii })], groups: [{}] });
  const { facts } = world.lookBack;
  assert.deepEqual(
    facts?.places.map(({ first, count, id, group }) => [first, count, id, group]),
    [
      [0, 1, 9n, 1],
      [1, 1, 1n, 0],
    ],
  );
  assert.deepEqual([facts.population, facts.groups.length], [2, 2]);
  assert.deepEqual([...new Float32Array(facts.radii.slice().buffer)], [0.125, 0.5]);
  world.change({ removed: [create(PlacesSchema, { first: 0, count: 2 })] });
  assert.deepEqual(
    world.lookBack.facts?.places.map(({ count }) => count),
    [0],
    "no place is in use",
  );
});

test("other scenes and connections keep their own facts", () => {
  const world = new World();
  world.connect({ name: "first" });
  world.run(100);
  world.load({ name: "second" });
  world.run(100);
  world.connect({ name: "third" });
  world.run(100);
  const nameAt = (ago: number): string | undefined => {
    const [facts] = world.seek(ago);
    return typeof facts === "object" && "name" in facts ? facts.name : undefined;
  };
  assert.deepEqual([nameAt(7), nameAt(4), nameAt(1)], ["first", "second", "third"]);
});

test("a chain that begins again in the same scene needs no new facts", () => {
  const world = new World();
  world.connect();
  world.run(100);
  world.run(100, { key: true });
  world.seek(5);
  assert.equal(world.seek(1).length, 1);
  assert.ok(isAt(world.seek(30 * spacing - 1e-4).at(-1), 170));
});

test("steps go from frame to frame, through a change of the chain, and end at the last one", () => {
  const world = new World();
  world.connect();
  world.run(100);
  world.run(5, { key: true });
  world.seek(7 * spacing - 1e-4);
  world.log.length = 0;
  for (let k = 0; k < 10; k++) world.player.step(1);
  const xs = world.log.map((entry) => (typeof entry === "object" && "x" in entry ? entry.x : entry));
  assert.deepEqual(xs, [99, 100, 101, 102, 103, 104, 105]);
  assert.equal(world.player.atEnd, true);
  world.seek(30 * spacing - 1e-4);
  world.log.length = 0;
  world.player.step(12);
  assert.ok(isAt(world.log[0], 105 - 30 + 12) && world.log.length === 1);
});

test("frames that the tables cannot describe are left out", () => {
  const world = new World();
  world.connect();
  world.run(10);
  const { frames } = world.lookBack.history;
  world.run(5, { population: 4 }); // the messages of these changes got lost
  assert.equal(world.lookBack.history.frames, frames);
});
