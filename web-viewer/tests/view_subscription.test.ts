import assert from "node:assert/strict";
import { test } from "node:test";
import { ViewSubscription } from "../src/connection/view_subscription";
import { Quantity, Tier } from "../src/gen/spherule/v1/frame_pb";
import { timers } from "./support/timers";

const defaults = { tier: Tier.NORMAL, rate: 30, fixed: false };

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

test("a quantity is requested at once, and given up after a while", () => {
  timers.enable();
  const requested: Quantity[] = [];
  const subscription = new ViewSubscription(defaults, (view) => void requested.push(view.quantity));
  assert.equal(subscription.view.quantity, Quantity.QUANTITY_UNSPECIFIED);
  for (let tick = 0; tick < 3; tick++) subscription.setQuantity(Quantity.SPEED);
  assert.deepEqual(requested, [Quantity.SPEED]);
  subscription.setQuantity(Quantity.QUANTITY_UNSPECIFIED);
  timers.tick(1000);
  subscription.setQuantity(Quantity.SPEED);
  timers.tick(10_000);
  assert.deepEqual(requested, [Quantity.SPEED], "the need has returned");
  subscription.setQuantity(Quantity.QUANTITY_UNSPECIFIED);
  timers.tick(10_000);
  assert.deepEqual(requested, [Quantity.SPEED, Quantity.QUANTITY_UNSPECIFIED]);
  subscription.setQuantity(Quantity.CONTACTS);
  subscription.setQuantity(Quantity.ENERGY);
  assert.deepEqual(requested.slice(2), [Quantity.CONTACTS, Quantity.ENERGY], "another quantity replaces it at once");
  timers.reset();
});

test("angular velocities are requested while they are needed", () => {
  const requested: boolean[] = [];
  const subscription = new ViewSubscription(defaults, (view) => void requested.push(view.spins));
  assert.equal(subscription.view.spins, false);
  for (const needed of [false, true, true, false]) subscription.setSpins(needed);
  assert.deepEqual(requested, [true, false]);
});
