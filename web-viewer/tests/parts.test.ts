import { create } from "@bufbuild/protobuf";
import assert from "node:assert/strict";
import { test } from "node:test";
import { Camera } from "../src/camera/camera";
import { Backoff } from "../src/connection/backoff";
import { RecordingSchema } from "../src/gen/spherule/v1/control_pb";
import type { Vec3 } from "../src/model/facts";
import { ladder, RenderQualityControl } from "../src/renderer/render_quality";
import { faces, planeInBox } from "../src/renderer/shapes";
import { bytes, bytesPerSecond, clockTime, count, figure, length, recordingTime } from "../src/ui/format";
import { keysFor } from "../src/ui/keys";
import { gravityPresetOf } from "../src/ui/presets";
import { recordingEnd } from "../src/ui/record";

test("waits double up to their limit, and start over after a success", () => {
  const backoff = new Backoff(100, 1000, () => 0);
  assert.deepEqual([1, 2, 3, 4, 5, 6].map(() => backoff.next()), [100, 200, 400, 800, 1000, 1000]);
  backoff.reset();
  assert.equal(backoff.next(), 100);
});

test("waits are shortened at random by at most a quarter", () => {
  assert.equal(new Backoff(100, 1000, () => 1).next(), 75);
});

test("quality decreases after several slow images, and only then", () => {
  const control = new RenderQualityControl("auto", false);
  for (let i = 0; i < 100; i++) control.took(i % 3 ? 16 : 50);
  assert.equal(control.quality, ladder[0]);
  for (let i = 0; i < 17; i++) control.took(50);
  assert.equal(control.quality, ladder[1]);
});

test("a chosen quality is kept, and a software renderer starts with light quality", () => {
  const control = new RenderQualityControl("full", true);
  for (let i = 0; i < 200; i++) control.took(500);
  assert.equal(control.quality, ladder[0]);
  assert.equal(new RenderQualityControl("auto", true).quality.occlusion, false);
});

test("a slanted plane cuts a box in a polygon with corners on both", () => {
  const points = planeInBox({ point: [0, 0, 0], normal: [0.6, 0, 0.8], colour: undefined }, [-1, -1, -1], [1, 1, 1]);
  assert.equal(points.length, 4);
  for (const [x, y, z] of points) {
    assert.ok(Math.abs(0.6 * x + 0.8 * z) < 1e-9);
    assert.equal(Math.max(Math.abs(x), Math.abs(y), Math.abs(z)), 1);
  }
});

test("a plane through opposite corners cuts a hexagon, one beside the box nothing", () => {
  const n = 1 / Math.sqrt(3);
  const diagonal = { point: [0, 0, 0] as Vec3, normal: [n, n, n] as Vec3, colour: undefined };
  const beside = { point: [0, 0, 9] as Vec3, normal: [0, 0, 1] as Vec3, colour: undefined };
  assert.equal(planeInBox(diagonal, [-1, -1, -1], [1, 1, 1]).length, 6);
  assert.equal(planeInBox(beside, [-1, -1, -1], [1, 1, 1]).length, 0);
});

test("a box has six faces, with corners in counterclockwise order", () => {
  for (const { normal, points } of faces([0, 0, 0], [1, 2, 3])) {
    const [a, b, c] = points;
    assert.ok(a && b && c);
    const u = a.map((value, i) => (b[i] ?? 0) - value);
    const v = a.map((value, i) => (c[i] ?? 0) - value);
    const product = (i: number, j: number): number => (u[i % 3] ?? 0) * (v[j % 3] ?? 0);
    const cross = [0, 1, 2].map((i) => product(i + 1, i + 2) - product(i + 2, i + 1));
    assert.ok(cross.reduce((sum, value, i) => sum + value * (normal[i] ?? 0), 0) > 0);
  }
});

test("figures are formatted with few digits", () => {
  assert.equal(count(1234567), "1\u202f234\u202f567");
  const figures = ["0", "1", "0.5", "12.3", "1234", "−0.0123", "99999"];
  assert.deepEqual([0, 1, 0.5, 12.34, 1234, -0.0123, 99999].map(figure), figures);
  assert.deepEqual([0.05, 1.5, 0.0023].map(length), ["5 cm", "1.5 m", "2.3 mm"]);
  assert.deepEqual([53_000, 1_234_000].map(bytesPerSecond), ["53 kB/s", "1.23 MB/s"]);
});

test("sizes and times of recordings are formatted", () => {
  assert.deepEqual([0, 18_000, 3_400_000, 2.5e9].map(bytes), ["0 kB", "18 kB", "3.4 MB", "2.50 GB"]);
  assert.deepEqual([0, 12.9, 75, 3671].map(clockTime), ["0:00", "0:12", "1:15", "1:01:11"]);
  const times = [[3.2, 10], [65, 200], [0.0123, 0.05], [0, 0]] as const;
  const texts = times.map(([time, duration]) => recordingTime(time, duration));
  assert.deepEqual(texts, ["3.20 s", "1:05", "0.0123 s", "0.00 s"]);
});

test("the end of a recording is reported once, with its file or the reason", () => {
  const active = create(RecordingSchema, { active: true, file: "r/a.sph" });
  const done = { ...active, active: false };
  const text = "Play it with spherule play r/a.sph";
  assert.deepEqual(recordingEnd(done, active), { title: "Recorded", text, failed: false });
  assert.equal(recordingEnd(done, done), undefined);
  assert.equal(recordingEnd(done, undefined), undefined); // it ended before the page connected
  assert.equal(recordingEnd(active, done), undefined);
  const full = { ...done, failure: "the disk is full" };
  assert.deepEqual(recordingEnd(full, active), { title: "Recording ended", text: "the disk is full", failed: true });
  assert.equal(recordingEnd(full, full), undefined);
  assert.equal(recordingEnd(full, done)?.failed, true); // it ended right after its start
});

test("for a recording, no key drops or pushes spheres, and descriptions fit", () => {
  const none = (): void => undefined;
  const buttons = { toggle: none, step: none, reset: none, panel: none, help: none };
  const others = { colour: none, push: none, lock: none, drop: none, deselect: none };
  const actions = { ...buttons, ...others, camera: new Camera() };
  const textsFor = (playing: boolean): string[] => keysFor(actions, playing).map((key) => key.description);
  const [live, played] = [textsFor(false), textsFor(true)];
  const missing = live.filter((text) => !played.includes(text));
  assert.deepEqual(missing, ["one step", "reset the scene", "drop spheres", "push mode"]);
  assert.deepEqual(played.filter((text) => !live.includes(text)), ["one frame", "go to the beginning"]);
});

test("a gravity preset is recognised by its values", () => {
  assert.equal(gravityPresetOf([0, 0, -1.62]), "Moon");
  assert.equal(gravityPresetOf([0, 0, -1.7]), "Custom");
});
