import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { Commands } from "../src/connection/commands";
import type { Report } from "../src/connection/commands";
import type { CommandKind, Link, Outcome } from "../src/connection/link";
import { AppliedSchema } from "../src/gen/spherule/v1/control_pb";

/** Commands that are all applied with the given fields; what was sent and reported. */
function createCommands(applied = {}, blocked = false) {
  const sent: CommandKind[] = [];
  const reports: Report[] = [];
  const outcome: Outcome = { case: "applied", value: create(AppliedSchema, { step: 12n, ...applied }) };
  const link = { send: (kind: CommandKind) => (sent.push(kind), Promise.resolve(outcome)) };
  const local = (command?: string): boolean => command === "seek";
  const report = (one: Report): void => void reports.push(one);
  const commands = new Commands(link as unknown as Link, report, local, () => blocked);
  return { commands, sent, reports };
}

test("a sphere is removed by its id, and the report says how many are gone", async () => {
  const { commands, sent, reports } = createCommands({ removed: 1n });
  await commands.remove(5_000_000_000);
  assert.deepEqual(
    sent.map((kind) => kind.case === "remove" && kind.value.spheres),
    [[5_000_000_000n]],
  );
  assert.deepEqual(
    reports.map(({ name, text }) => [name, text]),
    [["Remove sphere 5\u202f000\u202f000\u202f000", "removed 1 sphere"]],
  );
  const several = createCommands({ removed: 3n });
  await several.commands.remove(1);
  assert.equal(several.reports[0]?.text, "removed 3 spheres");
});

test("a push names the sphere by its id, and is reported as before", async () => {
  const { commands, sent, reports } = createCommands({ sphere: 17n });
  await commands.push({ origin: [0, 0, 0], direction: [1, 0, 0] }, 17, 2);
  const [kind] = sent;
  assert.ok(kind?.case === "push");
  assert.deepEqual([kind.value.target, kind.value.impulse], [{ case: "sphere", value: 17n }, [2, 0, 0]]);
  assert.deepEqual([reports[0]?.name, reports[0]?.text], ["Push sphere 17", "applied at step 12"]);
});

test("nothing is sent while the page may not send commands", async () => {
  const { commands, sent, reports } = createCommands({}, true);
  assert.equal((await commands.remove(1)).case, "lost");
  assert.deepEqual([sent, reports], [[], []]);
});
