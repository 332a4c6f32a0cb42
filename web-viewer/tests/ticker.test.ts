import FakeTimers from "@sinonjs/fake-timers";
import assert from "node:assert/strict";
import { test } from "node:test";
import { Ticker } from "../src/ticker";

const frame = 16; // ms between images of the fake clock

test("at rest there are four ticks a second, and as many as images while something happens", () => {
  const clock = FakeTimers.install({ toFake: ["performance", "setTimeout", "clearTimeout"] });
  const images = (callback: (now: number) => void): unknown => setTimeout(() => callback(performance.now()), frame);
  Object.assign(globalThis, { requestAnimationFrame: images });
  try {
    let ticks = 0;
    let draws = false;
    const ticker = new Ticker(() => {
      ticks += 1;
      return draws;
    });
    const during = (time: number): number => {
      const before = ticks;
      clock.tick(time);
      return ticks - before;
    };
    ticker.wake();
    const active = during(480);
    assert.ok(active >= 480 / frame - 2, `${active} ticks after an event`);
    during(500);
    const resting = during(2000);
    assert.ok(resting >= 6 && resting <= 8, `${resting} ticks at rest`);
    for (let k = 0; k < 10; k++) ticker.wake();
    assert.equal(during(2 * frame), 2, "several events make one tick per image");
    during(1000);
    ticker.request();
    assert.equal(during(frame), 1, "a message makes one tick");
    assert.equal(during(5 * frame), 0);
    draws = true;
    during(2000);
    assert.ok(during(2000) >= 2000 / frame - 2, "ticks go on while images are drawn");
    draws = false;
    during(1000);
    assert.ok(during(2000) <= 8);
  } finally {
    clock.uninstall();
    Reflect.deleteProperty(globalThis, "requestAnimationFrame");
  }
});
