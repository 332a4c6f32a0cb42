import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { StreamSchema } from "../src/gen/spherule/v1/control_pb";
import { Tier } from "../src/gen/spherule/v1/frame_pb";
import { Traffic } from "../src/model/traffic";
import { streamFigures } from "../src/ui/stream_labels";

test("the figures show the stream, and why it is reduced", () => {
  const rates = { frames: 15, bytes: 125_000, bytesPerSphere: 1.63, decodeMs: 2.5 };
  const sent = create(StreamSchema, { tier: Tier.ECO, rate: 15, reduced: true, reason: "the line is slow" });
  const view = { tier: Tier.NORMAL, rate: 15, fixed: false };
  const list = streamFigures(view, sent, rates, 12.3, 4);
  const rows = Object.fromEntries(list.map(({ id, value, warning }) => [id, { value, warning }]));
  assert.equal(rows["tier"]?.value, "Eco, 1/16 r");
  assert.match(rows["tier"].warning ?? "", /the line is slow/);
  assert.equal(rows["rate"]?.warning, "", "as many as requested");
  assert.deepEqual(
    ["rate", "bandwidth", "bytes", "decode", "late", "lost"].map((id) => rows[id]?.value),
    ["15 /s", "1 Mb/s", "1.63 B", "2.5 ms", "12 ms", "4"],
  );
  const nothing = streamFigures(view, undefined, new Traffic().rates(0), undefined, 0).map(({ value }) => value);
  assert.deepEqual(nothing, ["–", "–", "–", "–", "–", "–", "0"]);
});
