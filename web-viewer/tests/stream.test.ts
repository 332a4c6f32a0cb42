import assert from "node:assert/strict";
import { test } from "node:test";
import { Buffers } from "../src/connection/buffers";
import { Frames } from "../src/connection/frames";
import { KeyframeWish } from "../src/connection/keyframe_wish";
import type { Received } from "../src/connection/messages";
import { Stream } from "../src/connection/stream";
import { frameOf, keyframe, orderOf, still } from "./support/chain";
import { timers } from "./support/timers";

interface Said {
  sequence?: bigint;
  decodeMs?: number;
  drawRate?: number;
  lost?: boolean;
}

/** A stream of one sphere, with all that it says. */
function listening() {
  const acks: Said[] = [];
  const states: Received[] = [];
  const faults: string[] = [];
  let lost = 0;
  const frames = new Frames(new Buffers());
  const stream = new Stream(frames, {
    ack: (ack) => void acks.push(ack),
    decoded: (frame) => void states.push(frame),
    broken: (reason) => void faults.push(reason),
    lost: (count) => (lost = count),
  });
  frames.setScene(3, 1);
  frames.setOrder(orderOf([0]));
  const take = (sequence: number, spb: Uint8Array, fields = {}): void =>
    stream.take(frameOf(spb, { sequence: BigInt(sequence), count: 1, stampUs: 5_000_000n, ...fields }), 1234, 99);
  const asked = (): number[] => acks.filter((ack) => ack.lost).map((ack) => Number(ack.sequence));
  const close = (): void => stream.reset(); // forgets its timer
  return { acks, states, faults, frames, stream, take, asked, close, lost: () => lost };
}

test("each decoded frame is handed on and acked with what it took", () => {
  const { acks, states, stream, take } = listening();
  stream.drawRate = 48;
  take(10, keyframe(1, [[2, 4, 6]]));
  take(12, still(2, 1));
  assert.deepEqual(acks.map(({ sequence, drawRate, lost }) => [sequence, drawRate, lost]), [
    [10n, 48, false],
    [12n, 48, false],
  ]);
  assert.ok(acks.every(({ decodeMs = -1 }) => decodeMs >= 0));
  const [state] = states;
  assert.deepEqual([...(state?.positions ?? [])], [1, 2, 3]);
  assert.deepEqual([state?.sequence, state?.step, state?.simTime, state?.quantum], [10, 120, 2, 0.5]);
  assert.deepEqual([state?.arrival, state?.ready, state?.bytes], [1234, 5000, 99]);
});

test("a lost chain is said once and asked for once, then the rest is quiet until a keyframe", () => {
  const { acks, states, faults, take, asked, lost, close } = listening();
  take(1, keyframe(1, [[0, 0, 0]]));
  take(2, still(3, 1));
  take(3, still(4, 1));
  take(4, still(5, 1));
  assert.deepEqual(asked(), [2]);
  assert.equal(faults.length, 1);
  assert.equal(lost(), 3);
  assert.deepEqual(acks.map((ack) => Number(ack.sequence)), [1, 2, 3, 4], "the server hears of every frame");
  take(5, keyframe(6, [[0, 0, 0]]));
  take(6, still(7, 1));
  assert.equal(states.length, 3);
  close();
});

test("frames of another epoch are acked and nothing else", () => {
  const { acks, states, faults, take, lost } = listening();
  take(1, still(9, 1), { epoch: 2 });
  assert.deepEqual([acks.length, acks[0]?.lost, states.length, faults.length, lost()], [1, false, 0, 0, 0]);
});

test("keyframes that cannot be decoded do not make a loop", () => {
  const { faults, take, asked, lost, close } = listening();
  const broken = keyframe(1, [[0, 0, 0]]).subarray(0, 60);
  for (let sequence = 1; sequence <= 50; sequence++) take(sequence, broken);
  assert.deepEqual(asked(), [1]);
  assert.equal(faults.length, 1);
  assert.equal(lost(), 50);
  close();
});

test("keyframes are asked for ever more rarely while none helps", () => {
  timers.enable();
  let now = 0;
  const asked: [number, bigint][] = [];
  const wish = new KeyframeWish((sequence) => void asked.push([now, sequence]), () => now);
  for (now = 0; now <= 40_000; now += 500) {
    wish.want(BigInt(now));
    timers.tick(500);
  }
  const times = asked.map(([at]) => at);
  assert.equal(times[0], 0);
  assert.ok(times.length >= 4 && times.length <= 6, `${times}`);
  const waits = times.slice(1).map((at, k) => at - (times[k] ?? 0));
  for (let k = 1; k < waits.length; k++) assert.ok((waits[k] ?? 0) >= (waits[k - 1] ?? 0), `${waits}`);
  timers.reset();
});

test("a keyframe that came ends the plan to ask again", () => {
  timers.enable();
  let asked = 0;
  const wish = new KeyframeWish(() => void (asked += 1), () => 0);
  assert.deepEqual([wish.want(1n), wish.want(2n), wish.want(3n)], [true, false, false]);
  wish.forget();
  timers.tick(60_000);
  assert.equal(asked, 1);
  timers.reset();
});
