import assert from "node:assert/strict";
import { test } from "node:test";
import { capacity, PlayoutBuffer } from "../src/model/playout";

const frame = 1000 / 30; // ms

/** The simulated time that is shown, for states whose key is their index. */
function shownTime(playout: PlayoutBuffer, times: number[], now: number): number {
  const sample = playout.sample(now);
  assert.ok(sample);
  const from = times[sample.from] ?? NaN;
  const to = times[sample.to] ?? NaN;
  return from + sample.mix * (to - from);
}

/** Pushes a state every 1/30 s, delayed by `late`, and returns the time shown every 1/60 s after the first second. */
function play(late: (index: number) => number, skip: (index: number) => boolean = () => false): number[] {
  const playout = new PlayoutBuffer();
  const times: number[] = [];
  const shown: number[] = [];
  let next = 0;
  for (let now = 0; now < 4000; now += 1000 / 60) {
    while (next * frame + late(next) <= now) {
      times[next] = next / 30;
      if (!skip(next)) playout.push(next, next * frame + late(next), next / 30);
      next += 1;
    }
    if (now > 1000) shown.push(shownTime(playout, times, now));
  }
  return shown;
}

function steps(shown: number[]): number[] {
  return shown.slice(1).map((time, i) => time - (shown[i] ?? 0));
}

test("a steady stream is shown at an even speed", () => {
  for (const step of steps(play(() => 0))) assert.ok(Math.abs(step - 1 / 60) < 1e-3, `${step}`);
});

test("the image lags one to two frames behind the newest state", () => {
  const shown = play(() => 0);
  const newest = 4 - 1 / 60;
  const behind = newest - (shown.at(-1) ?? 0);
  assert.ok(behind > 1 / 30 && behind < 2.2 / 30, `${behind}`);
});

test("delays of up to a third of an interval have little effect", () => {
  const jitter = (index: number): number => ((index * 7919) % 11) * (frame / 33);
  for (const step of steps(play(jitter))) assert.ok(step > 0.005 && step < 0.03, `${step}`);
});

test("a skipped frame changes the speed by less than a quarter", () => {
  for (const step of steps(
    play(
      () => 0,
      (index) => index % 7 === 3,
    ),
  )) {
    assert.ok(step > 0.75 / 60 && step < 1.25 / 60, `${step}`);
  }
});

test("time never runs backwards", () => {
  const jitter = (index: number): number => (index % 5 === 0 ? 2.5 * frame : 0);
  for (const step of steps(play(jitter))) assert.ok(step >= 0, `${step}`);
});

test("after a pause, motion starts again without stretching over the pause", () => {
  const playout = new PlayoutBuffer();
  for (let i = 0; i < 30; i++) playout.push(i, i * frame, i / 30);
  playout.push(30, 10_000, 1);
  const held = playout.sample(10_000);
  assert.deepEqual([held?.to, held?.mix], [29, 1]);
  const half = playout.sample(10_000 + 1.6 * frame);
  assert.deepEqual([half?.from, half?.to], [29, 30]);
  assert.ok((half?.mix ?? 0) > 0.2 && (half?.mix ?? 0) < 0.8, `${half?.mix}`);
  const end = playout.sample(10_000 + 5 * frame);
  assert.deepEqual([end?.to, end?.mix, end?.moving], [30, 1, false]);
});

test("at rest the last two states are kept, so that speeds stay visible", () => {
  const playout = new PlayoutBuffer();
  for (let i = 0; i < 10; i++) playout.push(i, i * frame, i / 30);
  const sample = playout.sample(1e6);
  assert.deepEqual(sample, { from: 8, to: 9, mix: 1, moving: false });
});

test("a state of the same time replaces the newest one", () => {
  const playout = new PlayoutBuffer();
  playout.push(1, 0, 1);
  playout.push(2, frame, 2);
  assert.deepEqual(playout.push(3, 2 * frame, 2), [2]);
  assert.equal(playout.sample(1e6)?.to, 3);
});

test("a state of an earlier time clears the buffer", () => {
  const playout = new PlayoutBuffer();
  playout.push(1, 0, 1);
  playout.push(2, frame, 2);
  assert.deepEqual(playout.push(3, 2 * frame, 0), [1, 2]);
  assert.deepEqual(playout.sample(2 * frame), { from: 3, to: 3, mix: 1, moving: false });
});

/** Thirty states of a recording, 1/30 s apart, as they arrive at speed 1. */
function played(): PlayoutBuffer {
  const playout = new PlayoutBuffer();
  for (let i = 0; i < 30; i++) playout.push(i, i * frame, i / 30, { ...playing, paused: false });
  return playout;
}
const playing = { speed: 1, paused: false, spacing: 1 / 30 };
const paused = { ...playing, paused: true };

for (const [what, pace, wait] of [
  ["while it plays", playing, 2 * frame],
  ["soon after a pause", paused, 2 * frame],
  ["long after a pause", paused, 60_000],
] as const) {
  test(`a jump far ahead is shown at once, ${what}`, () => {
    const playout = played();
    const arrival = 29 * frame + wait;
    assert.deepEqual(playout.push(30, arrival, 8, pace), [26, 27, 28, 29]);
    assert.deepEqual(playout.sample(arrival), { from: 30, to: 30, mix: 1, moving: false });
  });
}

test("after a jump, motion continues from its target", () => {
  const playout = played();
  playout.push(30, 30 * frame, 8, playing);
  playout.push(31, 31 * frame, 8 + 1 / 30, playing);
  const sample = playout.sample(32 * frame);
  assert.deepEqual([sample?.from, sample?.to], [30, 31]);
});

test("while paused, a single step is shown within a frame, any number of times", () => {
  const playout = played();
  for (let i = 30; i < 60; i++) {
    const arrival = 1000 * i;
    assert.equal(playout.push(i, arrival, i / 30, paused).length, 1);
    assert.deepEqual(playout.sample(arrival + frame), { from: i - 1, to: i, mix: 1, moving: false });
  }
});

test("a stall is not a jump, because as much time was simulated", () => {
  const playout = played();
  playout.push(30, 29 * frame + 3000, 29 / 30 + 3, playing);
  const sample = playout.sample(29 * frame + 3000);
  assert.deepEqual([sample?.from, sample?.mix], [29, 0]);
});

test("neither faster playback nor a burst of delayed frames is a jump", () => {
  const fast = { ...playing, speed: 4 };
  const playout = played();
  for (let i = 1; i < 4; i++) playout.push(29 + i, 30 * frame, 29 / 30 + (4 * i) / 30, fast);
  assert.equal(playout.sample(30 * frame)?.to, 29);
});

test("the buffer keeps at most `capacity` states", () => {
  const playout = new PlayoutBuffer();
  const dropped: number[] = [];
  for (let i = 0; i < 20; i++) dropped.push(...playout.push(i, 0.01 * i, i)); // all at once
  assert.equal(dropped.length, 20 - capacity);
  assert.deepEqual(dropped, [...Array(20 - capacity).keys()]);
});
