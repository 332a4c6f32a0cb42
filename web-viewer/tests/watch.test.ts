import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { Clock } from "../src/clock";
import { Watch } from "../src/connection/watch";
import { keep, wishFrom } from "../src/connection/wish";
import { StreamSchema } from "../src/gen/spherule/v1/control_pb";
import { Tier } from "../src/gen/spherule/v1/frame_pb";
import { Lateness } from "../src/scene/lateness";
import { Traffic } from "../src/scene/traffic";
import { streamRows } from "../src/ui/stream_words";
import { timers } from "./support/timers";

const usual = { tier: Tier.NORMAL, rate: 30, fixed: false };

function memory(content?: string) {
  let kept: string | null = content ?? null;
  return () => ({ getItem: () => kept, setItem: (_: string, value: string) => void (kept = value) });
}

test("a wish is kept, and the address goes before it", () => {
  const store = memory();
  const none = new URLSearchParams();
  assert.deepEqual(wishFrom(none, store), usual);
  keep({ tier: Tier.ECO, rate: 10, fixed: true }, store);
  assert.deepEqual(wishFrom(none, store), { tier: Tier.ECO, rate: 10, fixed: true });
  assert.deepEqual(wishFrom(new URLSearchParams("tier=fine&rate=60"), store), { tier: Tier.FINE, rate: 60, fixed: true });
  assert.equal(wishFrom(new URLSearchParams("fixed"), memory()).fixed, true);
});

test("what makes no sense is no wish", () => {
  const none = new URLSearchParams("tier=best&rate=31");
  for (const content of ["", "null", "7", '{"tier": 2, "rate": "many", "fixed": "yes"}']) {
    assert.deepEqual(wishFrom(none, memory(content)), usual);
  }
  const forbidden = (): never => {
    throw new Error("not here");
  };
  assert.deepEqual(wishFrom(none, forbidden), usual);
  keep(usual, forbidden);
});

test("a hidden page asks for no frames after a while, and for its own again when it is shown", () => {
  timers.enable();
  const asked: number[] = [];
  const watch = new Watch(usual, (view) => void asked.push(view.rate));
  watch.show(true);
  watch.show(false);
  timers.tick(1000);
  watch.show(true);
  timers.tick(10_000);
  assert.deepEqual(asked, []);
  watch.show(false);
  timers.tick(10_000);
  assert.equal(watch.view.rate, 0, "also for the next hello");
  watch.want({ ...usual, rate: 60 });
  watch.show(true);
  assert.deepEqual(asked, [0, 0, 60]);
  timers.reset();
});

test("traffic forgets what is older than two seconds", () => {
  const traffic = new Traffic();
  for (let arrival = 0; arrival < 4000; arrival += 100) traffic.add({ arrival, bytes: 1000, count: 400, decodeMs: 3 });
  assert.deepEqual(traffic.rates(4000), { frames: 10, bytes: 10_000, bytesPerSphere: 2.5, decodeMs: 3 });
  assert.equal(traffic.rates(9000).frames, 0);
});

test("a frame is late against the quickest one, whatever the clocks say", () => {
  for (const ahead of [0, 1e6, -1e6]) {
    const lateness = new Lateness();
    assert.equal(lateness.newest, undefined);
    lateness.add(2e9 + 50, 2e9 + ahead);
    assert.equal(lateness.newest, 0);
    lateness.add(2e9 + 150, 2e9 + 33 + ahead);
    assert.equal(lateness.newest, 67);
    lateness.add(2e9 + 110, 2e9 + 66 + ahead);
    assert.equal(lateness.newest, 0);
  }
});

test("a quickest frame of long ago is forgotten", () => {
  const lateness = new Lateness();
  for (let at = 1e9; at < 1e9 + 3_600_000; at += 10_000) lateness.add(at * 1.0001, at); // clocks that drift apart
  assert.ok((lateness.newest ?? NaN) <= 60, `${lateness.newest}`);
});

test("pictures per second are told only while there is something to draw", () => {
  const clock = new Clock();
  let now = 1000;
  const ticks = (count: number, apart: number, drawn: boolean): void => {
    for (let k = 0; k < count; k++, now += apart) {
      clock.tick(now);
      if (drawn) clock.drew();
    }
  };
  ticks(20, 20, true);
  assert.equal(clock.drawRate, 0, "too short");
  ticks(100, 20, true);
  assert.ok(Math.abs(clock.drawRate - 50) < 1);
  ticks(20, 20, false);
  assert.ok(Math.abs(clock.drawRate - 50) < 1, "a rest says nothing of how fast it draws");
  ticks(200, 20, false);
  assert.equal(clock.drawRate, 0);
  ticks(10, 500, true);
  assert.equal(clock.drawRate, 2);
});

test("the table says what is sent, and why less", () => {
  const rates = { frames: 15, bytes: 125_000, bytesPerSphere: 1.63, decodeMs: 2.5 };
  const sent = create(StreamSchema, { tier: Tier.ECO, rate: 15, reduced: true, reason: "the line is slow" });
  const wish = { tier: Tier.NORMAL, rate: 15, fixed: false };
  const rows = Object.fromEntries(streamRows(wish, sent, rates, 12.3, 4).map(([id, , value, warning]) => [id, { value, warning }]));
  assert.equal(rows["tier"]?.value, "Eco, 1/16 r");
  assert.match(rows["tier"]?.warning ?? "", /the line is slow/);
  assert.equal(rows["rate"]?.warning, "", "as many as were wanted");
  assert.deepEqual(
    ["rate", "bandwidth", "bytes", "decode", "late", "lost"].map((id) => rows[id]?.value),
    ["15 /s", "1 Mb/s", "1.63 B", "2.5 ms", "12 ms", "4"],
  );
  const nothing = streamRows(wish, undefined, new Traffic().rates(0), undefined, 0).map(([, , value]) => value);
  assert.deepEqual(nothing, ["–", "–", "–", "–", "–", "–", "0"]);
});
