import assert from "node:assert/strict";
import { test } from "node:test";
import type { Outcome } from "../src/connection/link";
import { Seeker } from "../src/connection/seeker";

const spacing = 1 / 30;

/** A server that answers when the test says so. */
class FakeServer {
  now = 0; // ms
  newest = 0; // s
  readonly seeks: number[] = [];
  private readonly waiting: ((outcome: Outcome) => void)[] = [];
  readonly seeker = new Seeker(
    (time) => {
      this.seeks.push(time);
      return new Promise((resolve) => this.waiting.push(resolve));
    },
    () => this.now,
  );

  get pending(): number {
    return this.waiting.length;
  }

  async answer(how: "applied" | "refused" = "applied"): Promise<void> {
    this.waiting.shift()?.({ case: how, value: {} } as Outcome);
    await new Promise((resolve) => setImmediate(resolve));
  }

  update(newest: number, speed = 0): void {
    this.newest = newest;
    this.seeker.update({ now: this.now, newest, speed, spacing });
  }
}

test("one seek is in progress at a time, and only the latest waiting target is sent", async () => {
  const server = new FakeServer();
  for (const time of [1, 2, 3, 4]) server.seeker.seek(time);
  assert.deepEqual([server.seeks, server.pending], [[1], 1]);
  await server.answer();
  assert.deepEqual([server.seeks, server.pending], [[1, 4], 1]);
  await server.answer();
  assert.deepEqual([server.seeks, server.pending], [[1, 4], 0]);
  server.seeker.seek(5);
  assert.deepEqual(server.seeks, [1, 4, 5]);
});

test("the target holds until its state has arrived, whatever arrives before", async () => {
  const server = new FakeServer();
  server.update(1);
  server.seeker.seek(7);
  server.update(1);
  assert.equal(server.seeker.target, 7);
  await server.answer();
  server.update(1.02); // it was in transit when the answer arrived
  assert.equal(server.seeker.target, 7);
  server.update(7 - 0.9 * spacing);
  assert.equal(server.seeker.target, undefined);
});

test("during playback, the state may be ahead by the time played since", async () => {
  const server = new FakeServer();
  server.seeker.seek(7);
  await server.answer();
  server.now += 300;
  server.update(7.3, 0);
  assert.equal(server.seeker.target, 7);
  server.update(7.3, 1);
  assert.equal(server.seeker.target, undefined);
});

test("a target whose state does not arrive is dropped after a timeout", async () => {
  const server = new FakeServer();
  server.seeker.seek(7);
  await server.answer();
  server.now += 500;
  server.update(2);
  assert.equal(server.seeker.target, 7);
  server.now += 600;
  server.update(2);
  assert.equal(server.seeker.target, undefined);
});

test("a target is kept until its answer, and dropped at once by a refusal", async () => {
  const server = new FakeServer();
  server.seeker.seek(7);
  server.now += 10_000;
  server.update(7);
  assert.equal(server.seeker.target, 7);
  await server.answer("refused");
  assert.equal(server.seeker.target, undefined);
  server.seeker.seek(8);
  assert.deepEqual(server.seeks, [7, 8]);
});

test("a lead seeks to the earlier state first, and continues once that has arrived", async () => {
  const server = new FakeServer();
  server.seeker.seek(7, spacing);
  assert.deepEqual(server.seeks, [7 - spacing]);
  assert.equal(server.seeker.target, 7);
  await server.answer();
  for (const before of [1, 7]) server.update(before);
  assert.equal(server.seeks.length, 1);
  server.update(7 - spacing);
  assert.deepEqual(server.seeks, [7 - spacing, 7]);
  await server.answer();
  server.update(7);
  assert.equal(server.seeker.target, undefined);
});

test("a lead whose state does not arrive times out, and another target replaces it", async () => {
  const server = new FakeServer();
  server.seeker.seek(7, spacing);
  await server.answer();
  server.now += 200;
  server.update(1);
  assert.deepEqual(server.seeks, [7 - spacing, 7]);
  await server.answer();
  server.seeker.seek(5, spacing);
  await server.answer();
  server.seeker.seek(3);
  assert.equal(server.seeks.at(-1), 3);
  assert.equal(server.seeker.target, 3);
  assert.equal(server.pending, 1);
});

test("a late answer does not restore targets after a reset", async () => {
  const server = new FakeServer();
  server.seeker.seek(1);
  server.seeker.seek(2);
  server.seeker.reset();
  await server.answer();
  assert.deepEqual([server.seeks, server.seeker.target], [[1], undefined]);
  server.seeker.seek(3);
  server.seeker.reset();
  server.seeker.seek(4);
  await server.answer("refused"); // of 3
  assert.equal(server.seeker.target, 4);
  server.seeker.seek(5);
  assert.equal(server.pending, 1);
});
