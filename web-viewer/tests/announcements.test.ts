import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { CommandSchema, Event_Kind, EventSchema } from "../src/gen/spherule/v1/control_pb";
import { Model } from "../src/gen/spherule/v1/scene_pb";
import { announcementOf } from "../src/ui/announcements";

type Kind = NonNullable<MessageInitShape<typeof CommandSchema>["kind"]>;

function told(kind: Kind, { client = "Ada", spheres = 0n, playing = false } = {}) {
  const by = { session: 3n, client };
  const event = create(EventSchema, { kind: Event_Kind.COMMANDED, by, command: { kind }, spheres });
  return announcementOf(event, playing);
}

test("the page says who has done what", () => {
  const moon = told({ case: "set", value: { gravity: [0, 0, -1.62] } });
  assert.deepEqual(moon, { who: "Ada", what: "set gravity to Moon" });
  const what = (kind: Kind, more = {}) => told(kind, more)?.what;
  const several = { restitution: 0.25, speed: 2, model: Model.FAST, auto: {} };
  const expected = "set restitution to 0.25, speed to 2 ×, quality to Fast, automatic quality off";
  assert.equal(what({ case: "set", value: several }), expected);
  assert.equal(what({ case: "set", value: { gravity: [0, 1, -2.5] } }), "set gravity to 0  1  −2.5 m/s²");
  assert.equal(what({ case: "set", value: { substeps: 8 } }), "set quality to 8 substeps");
  assert.equal(what({ case: "pause", value: {} }), "paused the simulation");
  assert.equal(what({ case: "resume", value: {} }, { playing: true }), "resumed the playback");
  assert.equal(what({ case: "reset", value: {} }), "reset the scene");
  assert.equal(what({ case: "load", value: { source: { case: "name", value: "pour" } } }), "loaded pour");
  assert.equal(what({ case: "addField", value: {} }), "changed the scene");
  assert.equal(what({ case: "removeGroup", value: {} }, { spheres: 7n }), "removed a group with 7 spheres");
  assert.equal(what({ case: "spawn", value: {} }, { spheres: 1200n }), "added 1\u202f200 spheres");
  assert.equal(what({ case: "remove", value: {} }, { spheres: 1n }), "removed 1 sphere");
});

test("a client with the name of this page gets a number, and one without a name is somebody", () => {
  const who = (client: string) => told({ case: "pause", value: {} }, { client })?.who;
  assert.deepEqual(["spherule viewer", "", "A\u202eda"].map(who), ["spherule viewer #3", "somebody #3", "A da"]);
});

test("other events and commands are no announcements", () => {
  const command = { kind: { case: "pause" as const, value: {} } };
  const warning = create(EventSchema, { kind: Event_Kind.WARNING, by: { session: 3n, client: "Ada" }, command });
  assert.equal(announcementOf(warning, false), undefined);
  assert.equal(told({ case: "push", value: {} }), undefined);
});
