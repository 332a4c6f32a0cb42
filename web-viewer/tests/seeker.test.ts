import assert from "node:assert/strict";
import { test } from "node:test";
import type { Outcome } from "../src/connection/link";
import { Seeker } from "../src/connection/seeker";

const spacing = 1 / 30;

/** A server that answers when it is told to. */
class Far {
  now = 0; // ms
  newest = 0; // s
  readonly asked: number[] = [];
  private readonly waiting: ((outcome: Outcome) => void)[] = [];
  readonly seeker = new Seeker(
    (time) => {
      this.asked.push(time);
      return new Promise((resolve) => this.waiting.push(resolve));
    },
    () => this.now,
  );

  get underWay(): number {
    return this.waiting.length;
  }

  async answer(how: "applied" | "refused" = "applied"): Promise<void> {
    this.waiting.shift()?.({ case: how, value: {} } as Outcome);
    await new Promise((resolve) => setImmediate(resolve));
  }

  heed(newest: number, speed = 0): void {
    this.newest = newest;
    this.seeker.heed({ now: this.now, newest, speed, spacing });
  }
}

test("one seek is under way at a time, and of what waits only the latest goes out", async () => {
  const far = new Far();
  for (const time of [1, 2, 3, 4]) far.seeker.want(time);
  assert.deepEqual([far.asked, far.underWay], [[1], 1]);
  await far.answer();
  assert.deepEqual([far.asked, far.underWay], [[1, 4], 1]);
  await far.answer();
  assert.deepEqual([far.asked, far.underWay], [[1, 4], 0]);
  far.seeker.want(5);
  assert.deepEqual(far.asked, [1, 4, 5]);
});

test("the moment that is wanted holds until a state of it has come, whatever comes before", async () => {
  const far = new Far();
  far.heed(1);
  far.seeker.want(7);
  far.heed(1);
  assert.equal(far.seeker.wanted, 7);
  await far.answer();
  far.heed(1.02); // was on its way when the answer came
  assert.equal(far.seeker.wanted, 7);
  far.heed(7 - 0.9 * spacing);
  assert.equal(far.seeker.wanted, undefined);
});

test("while it plays, the state that comes may be as far ahead as has been played since", async () => {
  const far = new Far();
  far.seeker.want(7);
  await far.answer();
  far.now += 300;
  far.heed(7.3, 0);
  assert.equal(far.seeker.wanted, 7);
  far.heed(7.3, 1);
  assert.equal(far.seeker.wanted, undefined);
});

test("a moment of which no state comes is let go in the end", async () => {
  const far = new Far();
  far.seeker.want(7);
  await far.answer();
  far.now += 500;
  far.heed(2);
  assert.equal(far.seeker.wanted, 7);
  far.now += 600;
  far.heed(2);
  assert.equal(far.seeker.wanted, undefined);
});

test("before an answer nothing is let go, and a refusal lets go at once", async () => {
  const far = new Far();
  far.seeker.want(7);
  far.now += 10_000;
  far.heed(7);
  assert.equal(far.seeker.wanted, 7);
  await far.answer("refused");
  assert.equal(far.seeker.wanted, undefined);
  far.seeker.want(8);
  assert.deepEqual(far.asked, [7, 8]);
});

test("a lead shows the moment before first, and goes on once that is there", async () => {
  const far = new Far();
  far.seeker.want(7, spacing);
  assert.deepEqual(far.asked, [7 - spacing]);
  assert.equal(far.seeker.wanted, 7);
  await far.answer();
  for (const before of [1, 7]) far.heed(before);
  assert.equal(far.asked.length, 1);
  far.heed(7 - spacing);
  assert.deepEqual(far.asked, [7 - spacing, 7]);
  await far.answer();
  far.heed(7);
  assert.equal(far.seeker.wanted, undefined);
});

test("a lead of which no state comes holds nobody up, and another wish ends it", async () => {
  const far = new Far();
  far.seeker.want(7, spacing);
  await far.answer();
  far.now += 200;
  far.heed(1);
  assert.deepEqual(far.asked, [7 - spacing, 7]);
  await far.answer();
  far.seeker.want(5, spacing);
  await far.answer();
  far.seeker.want(3);
  assert.equal(far.asked.at(-1), 3);
  assert.equal(far.seeker.wanted, 3);
  assert.equal(far.underWay, 1);
});

test("what was forgotten does not come back with its answer", async () => {
  const far = new Far();
  far.seeker.want(1);
  far.seeker.want(2);
  far.seeker.forget();
  await far.answer();
  assert.deepEqual([far.asked, far.seeker.wanted], [[1], undefined]);
  far.seeker.want(3);
  far.seeker.forget();
  far.seeker.want(4);
  await far.answer("refused"); // of 3
  assert.equal(far.seeker.wanted, 4);
  far.seeker.want(5);
  assert.equal(far.underWay, 1);
});
