import assert from "node:assert/strict";
import { test } from "node:test";
import { BufferPool } from "../src/connection/buffer_pool";
import { Frames } from "../src/connection/frames";
import { KeyframeRequester } from "../src/connection/keyframe_request";
import type { Received } from "../src/connection/messages";
import { Stream } from "../src/connection/stream";
import { frameOf, keyframe, orderOf, still } from "./support/chain";
import { timers } from "./support/timers";

interface SentAck {
  sequence?: bigint;
  decodeMs?: number;
  drawRate?: number;
  lost?: boolean;
}

/** A stream of one sphere that logs its events. */
function createStream() {
  const acks: SentAck[] = [];
  const states: Received[] = [];
  const faults: string[] = [];
  let lost = 0;
  const frames = new Frames(new BufferPool());
  const stream = new Stream(frames, {
    ack: (ack) => void acks.push(ack),
    decoded: (frame) => void states.push(frame),
    malformed: (reason) => void faults.push(reason),
    lost: (count) => (lost = count),
  });
  frames.setScene(3, 1);
  frames.setOrder(orderOf([0]));
  const receive = (sequence: number, spb: Uint8Array, fields = {}): void => {
    const frame = frameOf(spb, { sequence: BigInt(sequence), count: 1, stampUs: 5_000_000n, ...fields });
    stream.receive(frame, new Uint8Array(99), 1234);
  };
  const requests = (): number[] => acks.filter((ack) => ack.lost).map((ack) => Number(ack.sequence));
  const close = (): void => stream.reset(); // cancels its timer
  return { acks, states, faults, frames, stream, receive, requests, close, lost: () => lost };
}

test("each decoded frame is passed on, and acknowledged with its decode time", () => {
  const { acks, states, stream, receive } = createStream();
  stream.drawRate = 48;
  receive(10, keyframe(1, [[2, 4, 6]]));
  receive(12, still(2, 1), { population: 3 });
  assert.deepEqual(
    acks.map(({ sequence, drawRate, lost }) => [sequence, drawRate, lost]),
    [
      [10n, 48, false],
      [12n, 48, false],
    ],
  );
  assert.ok(acks.every(({ decodeMs = -1 }) => decodeMs >= 0));
  const [state] = states;
  assert.deepEqual([...(state?.columns.position.values ?? [])], [2, 4, 6]);
  assert.deepEqual([state?.sequence, state?.step, state?.simTime, state?.columns.position.quantum], [10, 120, 2, 0.5]);
  assert.deepEqual(
    states.map(({ population }) => population),
    [0, 3],
  );
  assert.deepEqual([state?.arrival, state?.ready, state?.bytes], [1234, 5000, 99]);
});

test("a lost chain is reported once, and one keyframe is requested", () => {
  const { acks, states, faults, receive, requests, lost, close } = createStream();
  receive(1, keyframe(1, [[0, 0, 0]]));
  receive(2, still(3, 1));
  receive(3, still(4, 1));
  receive(4, still(5, 1));
  assert.deepEqual(requests(), [2]);
  assert.equal(faults.length, 1);
  assert.equal(lost(), 3);
  assert.deepEqual(
    acks.map((ack) => Number(ack.sequence)),
    [1, 2, 3, 4],
    "every frame is acknowledged",
  );
  receive(5, keyframe(6, [[0, 0, 0]]));
  receive(6, still(7, 1));
  assert.equal(states.length, 3);
  close();
});

test("frames of another epoch are acknowledged and ignored", () => {
  const { acks, states, faults, receive, lost } = createStream();
  receive(1, still(9, 1), { epoch: 2 });
  assert.deepEqual([acks.length, acks[0]?.lost, states.length, faults.length, lost()], [1, false, 0, 0, 0]);
});

test("malformed keyframes cause no flood of requests", () => {
  const { faults, receive, requests, lost, close } = createStream();
  const broken = keyframe(1, [[0, 0, 0]]).subarray(0, 60);
  for (let sequence = 1; sequence <= 50; sequence++) receive(sequence, broken);
  assert.deepEqual(requests(), [1]);
  assert.equal(faults.length, 1);
  assert.equal(lost(), 50);
  close();
});

test("the waits between requests grow while no keyframe helps", () => {
  timers.enable();
  let now = 0;
  const asked: [number, bigint][] = [];
  const keyframe = new KeyframeRequester(
    (sequence) => void asked.push([now, sequence]),
    () => now,
  );
  for (now = 0; now <= 40_000; now += 500) {
    keyframe.request(BigInt(now));
    timers.tick(500);
  }
  const times = asked.map(([at]) => at);
  assert.equal(times[0], 0);
  assert.ok(times.length >= 4 && times.length <= 6, `${times}`);
  const waits = times.slice(1).map((at, k) => at - (times[k] ?? 0));
  for (let k = 1; k < waits.length; k++) assert.ok((waits[k] ?? 0) >= (waits[k - 1] ?? 0), `${waits}`);
  timers.reset();
});

test("a decoded keyframe cancels the next request", () => {
  timers.enable();
  let asked = 0;
  const keyframe = new KeyframeRequester(
    () => void (asked += 1),
    () => 0,
  );
  assert.deepEqual([keyframe.request(1n), keyframe.request(2n), keyframe.request(3n)], [true, false, false]);
  keyframe.cancel();
  timers.tick(60_000);
  assert.equal(asked, 1);
  timers.reset();
});
