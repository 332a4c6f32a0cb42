import assert from "node:assert/strict";
import { test } from "node:test";
import { capacity, Timeline } from "../src/scene/timeline";

const frame = 1000 / 30; // ms

/** Where the shown picture stands in simulated time, given what was pushed under key = index. */
function shownTime(timeline: Timeline, times: number[], now: number): number {
  const moment = timeline.sample(now);
  assert.ok(moment);
  const from = times[moment.from] ?? NaN;
  const to = times[moment.to] ?? NaN;
  return from + moment.mix * (to - from);
}

/** Pushes a state every 1/30 s, each late by what `late` says, and returns what is shown every 1/60 s after a second. */
function play(late: (index: number) => number, skip: (index: number) => boolean = () => false): number[] {
  const timeline = new Timeline();
  const times: number[] = [];
  const shown: number[] = [];
  let next = 0;
  for (let now = 0; now < 4000; now += 1000 / 60) {
    while (next * frame + late(next) <= now) {
      times[next] = next / 30;
      if (!skip(next)) timeline.push(next, next * frame + late(next), next / 30);
      next += 1;
    }
    if (now > 1000) shown.push(shownTime(timeline, times, now));
  }
  return shown;
}

function steps(shown: number[]): number[] {
  return shown.slice(1).map((time, i) => time - (shown[i] ?? 0));
}

test("a steady stream is shown at an even pace", () => {
  for (const step of steps(play(() => 0))) assert.ok(Math.abs(step - 1 / 60) < 1e-3, `${step}`);
});

test("what is shown lies one to two frames behind what came", () => {
  const shown = play(() => 0);
  const newest = 4 - 1 / 60;
  const behind = newest - (shown.at(-1) ?? 0);
  assert.ok(behind > 1 / 30 && behind < 2.2 / 30, `${behind}`);
});

test("frames that are late by up to a third of an interval are not noticed", () => {
  const jitter = (index: number): number => ((index * 7919) % 11) * (frame / 33);
  for (const step of steps(play(jitter))) assert.ok(step > 0.005 && step < 0.03, `${step}`);
});

test("a skipped frame takes its time: the pace stays within a quarter", () => {
  for (const step of steps(play(() => 0, (index) => index % 7 === 3))) {
    assert.ok(step > 0.75 / 60 && step < 1.25 / 60, `${step}`);
  }
});

test("time never runs backwards", () => {
  const jitter = (index: number): number => (index % 5 === 0 ? 2.5 * frame : 0);
  for (const step of steps(play(jitter))) assert.ok(step >= 0, `${step}`);
});

test("after a pause the motion begins anew instead of stretching over it", () => {
  const timeline = new Timeline();
  for (let i = 0; i < 30; i++) timeline.push(i, i * frame, i / 30);
  timeline.push(30, 10_000, 1);
  const held = timeline.sample(10_000);
  assert.deepEqual([held?.to, held?.mix], [29, 1]);
  const half = timeline.sample(10_000 + 1.6 * frame);
  assert.deepEqual([half?.from, half?.to], [29, 30]);
  assert.ok((half?.mix ?? 0) > 0.2 && (half?.mix ?? 0) < 0.8, `${half?.mix}`);
  const end = timeline.sample(10_000 + 5 * frame);
  assert.deepEqual([end?.to, end?.mix, end?.moving], [30, 1, false]);
});

test("at rest the last pair stays, so that speeds can still be told", () => {
  const timeline = new Timeline();
  for (let i = 0; i < 10; i++) timeline.push(i, i * frame, i / 30);
  const moment = timeline.sample(1e6);
  assert.deepEqual(moment, { from: 8, to: 9, mix: 1, moving: false });
});

test("a state of the same time takes the newest one's place", () => {
  const timeline = new Timeline();
  timeline.push(1, 0, 1);
  timeline.push(2, frame, 2);
  assert.deepEqual(timeline.push(3, 2 * frame, 2), [2]);
  assert.equal(timeline.sample(1e6)?.to, 3);
});

test("a state of an earlier time starts over", () => {
  const timeline = new Timeline();
  timeline.push(1, 0, 1);
  timeline.push(2, frame, 2);
  assert.deepEqual(timeline.push(3, 2 * frame, 0), [1, 2]);
  assert.deepEqual(timeline.sample(2 * frame), { from: 3, to: 3, mix: 1, moving: false });
});

/** Thirty states of a recording, 1/30 s apart, as they come while it plays at speed 1. */
function played(): Timeline {
  const timeline = new Timeline();
  for (let i = 0; i < 30; i++) timeline.push(i, i * frame, i / 30, { ...playing, paused: false });
  return timeline;
}
const playing = { speed: 1, paused: false, spacing: 1 / 30 };
const paused = { ...playing, paused: true };

for (const [what, pace, wait] of [
  ["while it plays", playing, 2 * frame],
  ["soon after a pause", paused, 2 * frame],
  ["long after a pause", paused, 60_000],
] as const) {
  test(`a jump far ahead is shown at once, ${what}`, () => {
    const timeline = played();
    const arrival = 29 * frame + wait;
    assert.deepEqual(timeline.push(30, arrival, 8, pace), [26, 27, 28, 29]);
    assert.deepEqual(timeline.sample(arrival), { from: 30, to: 30, mix: 1, moving: false });
  });
}

test("what is due after a jump moves on from where it went", () => {
  const timeline = played();
  timeline.push(30, 30 * frame, 8, playing);
  timeline.push(31, 31 * frame, 8 + 1 / 30, playing);
  const moment = timeline.sample(32 * frame);
  assert.deepEqual([moment?.from, moment?.to], [30, 31]);
});

test("the next frame of a recording that stands still is there within a frame, however often that is asked for", () => {
  const timeline = played();
  for (let i = 30; i < 60; i++) {
    const arrival = 1000 * i;
    assert.equal(timeline.push(i, arrival, i / 30, paused).length, 1);
    assert.deepEqual(timeline.sample(arrival + frame), { from: i - 1, to: i, mix: 1, moving: false });
  }
});

test("a stall is no jump: as much time as passed was played", () => {
  const timeline = played();
  timeline.push(30, 29 * frame + 3000, 29 / 30 + 3, playing);
  const moment = timeline.sample(29 * frame + 3000);
  assert.deepEqual([moment?.from, moment?.mix], [29, 0]);
});

test("faster playback is no jump, nor are frames that were held up and come at once", () => {
  const fast = { ...playing, speed: 4 };
  const timeline = played();
  for (let i = 1; i < 4; i++) timeline.push(29 + i, 30 * frame, 29 / 30 + (4 * i) / 30, fast);
  assert.equal(timeline.sample(30 * frame)?.to, 29);
});

test("no more states are kept than there is room for", () => {
  const timeline = new Timeline();
  const dropped: number[] = [];
  for (let i = 0; i < 20; i++) dropped.push(...timeline.push(i, 0.01 * i, i)); // all at once
  assert.equal(dropped.length, 20 - capacity);
  assert.deepEqual(dropped, [...Array(20 - capacity).keys()]);
});
