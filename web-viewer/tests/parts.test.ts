import assert from "node:assert/strict";
import { test } from "node:test";
import { Backoff } from "../src/connection/backoff";
import { ladder, QualityControl } from "../src/renderer/quality";
import { faces, planeInBox } from "../src/renderer/shapes";
import { create } from "@bufbuild/protobuf";
import { Camera } from "../src/camera/camera";
import { RecordingSchema } from "../src/gen/spherule/v1/control_pb";
import { bytes, bytesPerSecond, count, figure, length } from "../src/ui/format";
import { presetOf } from "../src/ui/gravity";
import { keysFor } from "../src/ui/key_list";
import { clockTime, moment } from "../src/ui/moment";
import { endOf } from "../src/ui/record";

test("waits double up to their limit and start over after a success", () => {
  const backoff = new Backoff(100, 1000, () => 0);
  assert.deepEqual([1, 2, 3, 4, 5, 6].map(() => backoff.next()), [100, 200, 400, 800, 1000, 1000]);
  backoff.reset();
  assert.equal(backoff.next(), 100);
});

test("waits are shortened at random by at most a quarter", () => {
  assert.equal(new Backoff(100, 1000, () => 1).next(), 75);
});

test("quality goes down after a run of slow pictures, and only then", () => {
  const control = new QualityControl("auto", false);
  for (let i = 0; i < 100; i++) control.took(i % 3 ? 16 : 50);
  assert.equal(control.quality, ladder[0]);
  for (let i = 0; i < 17; i++) control.took(50);
  assert.equal(control.quality, ladder[1]);
});

test("a quality that was asked for stays, and software starts light", () => {
  const control = new QualityControl("full", true);
  for (let i = 0; i < 200; i++) control.took(500);
  assert.equal(control.quality, ladder[0]);
  assert.equal(new QualityControl("auto", true).quality.occlusion, false);
});

test("a slanted plane cuts a box in a polygon whose corners lie on both", () => {
  const points = planeInBox({ point: [0, 0, 0], normal: [0.6, 0, 0.8], colour: undefined }, [-1, -1, -1], [1, 1, 1]);
  assert.equal(points.length, 4);
  for (const [x, y, z] of points) {
    assert.ok(Math.abs(0.6 * x + 0.8 * z) < 1e-9);
    assert.equal(Math.max(Math.abs(x), Math.abs(y), Math.abs(z)), 1);
  }
});

test("a plane through opposite corners cuts a hexagon, one beside the box nothing", () => {
  const n = 1 / Math.sqrt(3);
  assert.equal(planeInBox({ point: [0, 0, 0], normal: [n, n, n], colour: undefined }, [-1, -1, -1], [1, 1, 1]).length, 6);
  assert.equal(planeInBox({ point: [0, 0, 9], normal: [0, 0, 1], colour: undefined }, [-1, -1, -1], [1, 1, 1]).length, 0);
});

test("a box has six faces, each with its corners in the order that its normal says", () => {
  for (const { normal, points } of faces([0, 0, 0], [1, 2, 3])) {
    const [a, b, c] = points;
    assert.ok(a && b && c);
    const u = a.map((value, i) => (b[i] ?? 0) - value);
    const v = a.map((value, i) => (c[i] ?? 0) - value);
    const cross = [0, 1, 2].map((i) => (u[(i + 1) % 3] ?? 0) * (v[(i + 2) % 3] ?? 0) - (u[(i + 2) % 3] ?? 0) * (v[(i + 1) % 3] ?? 0));
    assert.ok(cross.reduce((sum, value, i) => sum + value * (normal[i] ?? 0), 0) > 0);
  }
});

test("figures read well", () => {
  assert.equal(count(1234567), "1\u202f234\u202f567");
  assert.deepEqual([0, 1, 0.5, 12.34, 1234, -0.0123, 99999].map(figure), ["0", "1", "0.5", "12.3", "1234", "−0.0123", "99999"]);
  assert.deepEqual([0.05, 1.5, 0.0023].map(length), ["5 cm", "1.5 m", "2.3 mm"]);
  assert.deepEqual([53_000, 1_234_000].map(bytesPerSecond), ["53 kB/s", "1.23 MB/s"]);
});

test("sizes and times of recordings read well", () => {
  assert.deepEqual([0, 18_000, 3_400_000, 2.5e9].map(bytes), ["0 kB", "18 kB", "3.4 MB", "2.50 GB"]);
  assert.deepEqual([0, 12.9, 75, 3671].map(clockTime), ["0:00", "0:12", "1:15", "1:01:11"]);
  assert.deepEqual([moment(3.2, 10), moment(65, 200), moment(0.0123, 0.05), moment(0, 0)], ["3.20 s", "1:05", "0.0123 s", "0.00 s"]);
});

test("the end of a recording is told once: its file, or why it ended", () => {
  const active = create(RecordingSchema, { active: true, file: "r/a.sph" });
  const done = { ...active, active: false };
  assert.deepEqual(endOf(done, active), { title: "Recorded", text: "Play it with spherule play r/a.sph", failed: false });
  assert.equal(endOf(done, done), undefined);
  assert.equal(endOf(done, undefined), undefined); // it ended before the page came
  assert.equal(endOf(active, done), undefined);
  const full = { ...done, failure: "the disk is full" };
  assert.deepEqual(endOf(full, active), { title: "Recording ended", text: "the disk is full", failed: true });
  assert.equal(endOf(full, full), undefined);
  assert.equal(endOf(full, done)?.failed, true); // it had hardly begun
});

test("where a recording is played, no key drops or pushes spheres, and the others say what they do there", () => {
  const none = (): void => undefined;
  const act = { toggle: none, step: none, reset: none, panel: none, colour: none, push: none, lock: none, drop: none, help: none, forget: none };
  const says = (playing: boolean): string[] => keysFor({ ...act, camera: new Camera() }, playing).map((key) => key.says);
  const gone = says(false).filter((words) => !says(true).includes(words));
  assert.deepEqual(gone, ["one step", "reset the scene", "drop spheres", "push mode"]);
  assert.deepEqual(says(true).filter((words) => !says(false).includes(words)), ["one frame", "to the beginning"]);
});

test("a preset is known by its numbers", () => {
  assert.equal(presetOf([0, 0, -1.62]), "Moon");
  assert.equal(presetOf([0, 0, -1.7]), "Own");
});
