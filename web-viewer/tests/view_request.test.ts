import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { DrawClock } from "../src/clock";
import { ViewSubscription } from "../src/connection/view_subscription";
import { loadViewRequest, saveViewRequest } from "../src/connection/view_request";
import { StreamSchema } from "../src/gen/spherule/v1/control_pb";
import { Tier } from "../src/gen/spherule/v1/frame_pb";
import { DelayMeter } from "../src/model/delay";
import { Traffic } from "../src/model/traffic";
import { streamRows } from "../src/ui/stream_labels";
import { timers } from "./support/timers";

const defaults = { tier: Tier.NORMAL, rate: 30, fixed: false };

function memory(content?: string) {
  let kept: string | null = content ?? null;
  return () => ({ getItem: () => kept, setItem: (_: string, value: string) => void (kept = value) });
}

test("a view request is saved, and the address overrides it", () => {
  const store = memory();
  const none = new URLSearchParams();
  assert.deepEqual(loadViewRequest(none, store), defaults);
  saveViewRequest({ tier: Tier.ECO, rate: 10, fixed: true }, store);
  assert.deepEqual(loadViewRequest(none, store), { tier: Tier.ECO, rate: 10, fixed: true });
  const fine = new URLSearchParams("tier=fine&rate=60");
  assert.deepEqual(loadViewRequest(fine, store), { tier: Tier.FINE, rate: 60, fixed: true });
  assert.equal(loadViewRequest(new URLSearchParams("fixed"), memory()).fixed, true);
});

test("invalid values are ignored", () => {
  const none = new URLSearchParams("tier=best&rate=31");
  for (const content of ["", "null", "7", '{"tier": 2, "rate": "many", "fixed": "yes"}']) {
    assert.deepEqual(loadViewRequest(none, memory(content)), defaults);
  }
  const forbidden = (): never => {
    throw new Error("not here");
  };
  assert.deepEqual(loadViewRequest(none, forbidden), defaults);
  saveViewRequest(defaults, forbidden);
});

test("a hidden page requests no frames after a while, and its own rate again when it is shown", () => {
  timers.enable();
  const requested: number[] = [];
  const subscription = new ViewSubscription(defaults, (view) => void requested.push(view.rate));
  subscription.setVisible(true);
  subscription.setVisible(false);
  timers.tick(1000);
  subscription.setVisible(true);
  timers.tick(10_000);
  assert.deepEqual(requested, []);
  subscription.setVisible(false);
  timers.tick(10_000);
  assert.equal(subscription.view.rate, 0, "also for the next hello");
  subscription.request({ ...defaults, rate: 60 });
  subscription.setVisible(true);
  assert.deepEqual(requested, [0, 0, 60]);
  timers.reset();
});

test("traffic covers the last two seconds", () => {
  const traffic = new Traffic();
  for (let arrival = 0; arrival < 4000; arrival += 100) traffic.add({ arrival, bytes: 1000, count: 400, decodeMs: 3 });
  assert.deepEqual(traffic.rates(4000), { frames: 10, bytes: 10_000, bytesPerSphere: 2.5, decodeMs: 3 });
  assert.equal(traffic.rates(9000).frames, 0);
});

test("the delay is relative to the fastest frame, and independent of clock offsets", () => {
  for (const ahead of [0, 1e6, -1e6]) {
    const delay = new DelayMeter();
    assert.equal(delay.newest, undefined);
    delay.add(2e9 + 50, 2e9 + ahead);
    assert.equal(delay.newest, 0);
    delay.add(2e9 + 150, 2e9 + 33 + ahead);
    assert.equal(delay.newest, 67);
    delay.add(2e9 + 110, 2e9 + 66 + ahead);
    assert.equal(delay.newest, 0);
  }
});

test("old frames do not count as the fastest", () => {
  const delay = new DelayMeter();
  for (let at = 1e9; at < 1e9 + 3_600_000; at += 10_000) delay.add(at * 1.0001, at); // clocks that drift apart
  assert.ok((delay.newest ?? NaN) <= 60, `${delay.newest}`);
});

test("a draw rate is reported only during continuous drawing", () => {
  const clock = new DrawClock();
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
  assert.ok(Math.abs(clock.drawRate - 50) < 1, "a pause does not change the rate");
  ticks(200, 20, false);
  assert.equal(clock.drawRate, 0);
  ticks(10, 500, true);
  assert.equal(clock.drawRate, 2);
});

test("the table shows the stream, and why it is reduced", () => {
  const rates = { frames: 15, bytes: 125_000, bytesPerSphere: 1.63, decodeMs: 2.5 };
  const sent = create(StreamSchema, { tier: Tier.ECO, rate: 15, reduced: true, reason: "the line is slow" });
  const view = { tier: Tier.NORMAL, rate: 15, fixed: false };
  const table = streamRows(view, sent, rates, 12.3, 4);
  const rows = Object.fromEntries(table.map(([id, , value, warning]) => [id, { value, warning }]));
  assert.equal(rows["tier"]?.value, "Eco, 1/16 r");
  assert.match(rows["tier"]?.warning ?? "", /the line is slow/);
  assert.equal(rows["rate"]?.warning, "", "as many as requested");
  assert.deepEqual(
    ["rate", "bandwidth", "bytes", "decode", "late", "lost"].map((id) => rows[id]?.value),
    ["15 /s", "1 Mb/s", "1.63 B", "2.5 ms", "12 ms", "4"],
  );
  const nothing = streamRows(view, undefined, new Traffic().rates(0), undefined, 0).map(([, , value]) => value);
  assert.deepEqual(nothing, ["–", "–", "–", "–", "–", "–", "0"]);
});
