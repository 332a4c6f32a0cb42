import assert from "node:assert/strict";
import { test } from "node:test";
import { DrawClock } from "../src/clock";

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
