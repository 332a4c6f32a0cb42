// Whether a page has what the server has.
import assert from "node:assert/strict";
import { when } from "./browser.mjs";
import { serverSays } from "./raw.mjs";

/**
 * In a paused world: all positions of the page are those of the frames that the server sends for what the page asks for, bit by
 * bit but for rounding, and are within the tier's error of what it sends at its finest, which is itself off by a tenth of that.
 */
export async function expectPositionsOfServer(page) {
  const said = await serverSays(page);
  const fine = await serverSays(page, { tier: "FINE" });
  await when(page, (step) => spherule.step === step, said.step);
  const seen = await page.evaluate((count) => spherule.positions([...Array(count).keys()]), said.positions.length);
  assert.equal(await page.evaluate(() => spherule.count), said.positions.length);
  assert.deepEqual([seen.step, seen.quantum, fine.step], [said.step, said.quantum, said.step]);
  assert.ok(fine.quantum < said.quantum / 9);
  const error = (said.quantum + fine.quantum) / 2 + said.quantum / 1000;
  seen.positions.forEach((place, id) => {
    place.forEach((value, axis) => {
      assert.ok(Math.abs(value - said.positions[id][axis]) < said.quantum / 1000, `sphere ${id}`);
      assert.ok(Math.abs(value - fine.positions[id][axis]) < error, `sphere ${id}, against the finest tier`);
    });
  });
}
