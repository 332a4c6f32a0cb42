import assert from "node:assert/strict";
import { test } from "node:test";
import { pageStateOf } from "../src/model/page_state";
import type { Circumstances, Situation } from "../src/model/page_state";
import { noticesFor, OutsideCount } from "../src/ui/notices";
import type { Notice, NoticeInfo } from "../src/ui/notices";

const good: Circumstances = {
  connection: "open",
  attempted: false,
  refusal: "",
  farewell: "",
  deviceLost: false,
  spheres: 3,
};

const cases: [Partial<Circumstances>, Situation][] = [
  [{}, "live"],
  [{ spheres: 0 }, "empty"],
  [{ spheres: undefined }, "waiting"],
  [{ connection: "connecting", spheres: undefined }, "connecting"],
  [{ connection: "connecting", spheres: undefined, attempted: true }, "offline"],
  [{ connection: "connecting", attempted: true }, "offline"],
  [{ connection: "waiting", attempted: true }, "offline"],
  [{ connection: "waiting", attempted: true, refusal: "full" }, "refused"],
  [{ connection: "connecting", attempted: true, refusal: "full" }, "refused"],
  [{ connection: "silent" }, "silent"],
  [{ connection: "silent", spheres: 0 }, "silent"],
  [{ farewell: "bye" }, "ended"],
  [{ connection: "waiting", farewell: "bye" }, "ended"],
  [{ connection: "connecting", farewell: "bye", deviceLost: true }, "lost"],
  [{ connection: "locked", farewell: "bye" }, "locked"],
];

test("the page is in one state, whatever the connection and the scene are", () => {
  for (const [change, expected] of cases) {
    assert.equal(pageStateOf({ ...good, ...change }).situation, expected, JSON.stringify(change));
  }
});

test("figures are current, and commands can be sent, only while the server answers and the scene is known", () => {
  for (const [change] of cases) {
    const { situation, current, blockedReason } = pageStateOf({ ...good, ...change });
    const usable = situation === "live" || situation === "empty";
    assert.deepEqual([current, blockedReason === ""], [usable, usable], situation);
  }
});

function notices(change: Partial<Circumstances>, more: Partial<NoticeInfo> = {}) {
  const state = pageStateOf({ ...good, ...change });
  const rest = { graphics: "ok", host: "here", refusal: "full", farewell: "bye", outside: 0, diverged: false } as const;
  return noticesFor({ state, ...rest, link: undefined, known: state.situation !== "connecting", ...more });
}

test("every state but the normal one has a notice, which says what to do", () => {
  for (const [change, expected] of cases) {
    const [first, ...others] = notices(change);
    assert.deepEqual([first?.id ?? "live", others.length], [expected, 0]);
    const waits = ["connecting", "waiting", "live"].includes(expected);
    assert.equal((first?.actions.length ?? 0) > 0, !waits, expected);
  }
});

test("an old picture is called old, and a page without one says nothing of it", () => {
  const texts = [true, false].map((known) => notices({ connection: "waiting" }, { known })[0]?.text);
  assert.deepEqual(texts, [
    "This page tries again by itself. The picture and the figures are old.",
    "This page tries again by itself.",
  ]);
});

test("spheres outside and instability are reported only while figures are current", () => {
  const ids = (change: Partial<Circumstances>): string[] =>
    notices(change, { outside: 2, diverged: true }).map(({ id }) => id);
  assert.deepEqual(ids({}), ["diverged", "outside"]);
  assert.deepEqual(ids({ connection: "silent" }), ["silent"]);
  const titles = [1, 2].map((outside) => notices({}, { outside })[0]?.title);
  assert.deepEqual(titles, ["1 sphere left the scene", "2 spheres left the scene"]);
});

test("a link to another scene is reported, and the scene can be loaded if the server has it", () => {
  const notice = (loadable: boolean): Notice | undefined =>
    notices({}, { link: { name: "bounce", shown: "pour", loadable } })[0];
  assert.deepEqual([notice(true)?.actions, notice(false)?.actions], [["load", "dismiss"], ["dismiss"]]);
  assert.match(`${notice(true)?.title}. ${notice(true)?.text}`, /^This link is for bounce\. The server shows pour\. /);
  assert.equal(notice(false)?.text, "The server shows pour and does not have bounce.");
});

test("a page that cannot draw says so beside the state of the connection", () => {
  const ids = (["none", "lost"] as const).map((graphics) =>
    notices({ connection: "waiting" }, { graphics }).map(({ id }) => id),
  );
  assert.deepEqual(ids, [
    ["offline", "no-graphics"],
    ["offline", "graphics-lost"],
  ]);
});

test("a dismissed number of spheres outside is reported again once it has doubled", () => {
  const outside = new OutsideCount();
  assert.equal(outside.due(2), 2);
  outside.dismiss(2);
  assert.deepEqual(
    [2, 3, 4].map((count) => outside.due(count)),
    [0, 0, 4],
  );
  outside.dismiss(4);
  assert.equal(outside.due(0), 0); // the scene was reset
  assert.equal(outside.due(1), 1);
});
