// Compares a page with the server.
import assert from "node:assert/strict";
import { evaluateLarge, when } from "./browser.mjs";
import { queryServer } from "./raw.mjs";

/**
 * For a paused simulation: checks all positions of the page against the frames that the server sends for the same view,
 * up to rounding. Also checks them against the finest tier, within the errors of both tiers.
 */
export async function expectPositionsOfServer(page) {
  const sent = await queryServer(page);
  const fine = await queryServer(page, { tier: "FINE" });
  await when(page, (step) => spherule.session.newest?.step === step, sent.step);
  const seen = await evaluateLarge(
    page,
    (count) => spherule.positions([...Array(count).keys()]),
    sent.positions.length,
  );
  assert.equal(await page.evaluate(() => spherule.spheres), sent.positions.length);
  assert.deepEqual([seen.step, seen.quantum, fine.step], [sent.step, sent.quantum, sent.step]);
  assert.ok(fine.quantum < sent.quantum / 9);
  const error = (sent.quantum + fine.quantum) / 2 + sent.quantum / 1000;
  seen.positions.forEach((place, id) => {
    place.forEach((value, axis) => {
      assert.ok(Math.abs(value - sent.positions[id][axis]) < sent.quantum / 1000, `sphere ${id}`);
      assert.ok(Math.abs(value - fine.positions[id][axis]) < error, `sphere ${id}, against the finest tier`);
    });
  });
}
