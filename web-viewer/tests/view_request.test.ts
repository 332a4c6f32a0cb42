import assert from "node:assert/strict";
import { test } from "node:test";
import { loadViewRequest, saveViewRequest } from "../src/connection/view_request";
import { Tier } from "../src/gen/spherule/v1/frame_pb";

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
