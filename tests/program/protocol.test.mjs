// Checks docs/protocol.md: its examples run unchanged, its ranges equal the server's ranges, and `load` keeps the
// documented settings.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { serve, stopAll } from "../browser/support/server.mjs";
import { loadDecoder } from "../../web-viewer/tools/decoder.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const { WebSocket } = createRequire(path.join(root, "tests/browser/package.json"))("ws"); // Node has its own WebSocket since version 22
const documentText = readFileSync(path.join(root, "docs/protocol.md"), "utf8");
const blocks = documentText.split("\n## Examples")[1].matchAll(/^```(\w+)\n([^]*?)^```/gm);
const examples = [...blocks].map(([, kind, text]) => ({ kind, text }));

let folder;
let server;
let client;
before(async () => {
  folder = mkdtempSync(path.join(os.tmpdir(), "spherule-protocol-"));
  server = await serve("box-4k", { device: "cpu:1", options: ["--recordings", folder] });
  client = await connect({ rate: 0 });
});
after(async () => {
  client?.socket.close();
  await stopAll();
  rmSync(folder, { recursive: true });
});

const address = () => `ws://127.0.0.1:${server.port}/ws`;
const here = (text) => text.replaceAll("ws://127.0.0.1:8080/ws", address());

/** Connects a JSON session, whose `heard` has the newest message of each kind. */
async function connect(view) {
  const socket = new WebSocket(address(), "spherule.v1");
  const heard = {};
  const results = new Map();
  let last = 0;
  socket.on("message", (data) => {
    const message = JSON.parse(data);
    Object.assign(heard, message);
    if (!message.result) return;
    results.get(message.result.id)?.(message.result);
    results.delete(message.result.id);
  });
  await new Promise((resolve, reject) => socket.on("open", resolve).on("error", reject));
  socket.send(JSON.stringify({ hello: { client: "test", view } }));
  const say = (message) => socket.send(JSON.stringify(message));
  /** Sends a command; returns its result. */
  const command = (words) =>
    new Promise((resolve) => {
      results.set(String(++last), resolve);
      say({ command: { id: last, ...words } });
    });
  return { socket, heard, say, command };
}

async function until(condition) {
  for (let k = 0; k < 400 && !condition(); k++) await new Promise((resolve) => setTimeout(resolve, 50));
  assert.ok(condition());
}

/** Checks that this number of steps is accepted, then cancels them. */
async function begun(count) {
  const result = client.command({ step: { count } });
  if (count === 1) return assert.ok((await result).applied);
  await applied({ cancel: {} });
  assert.match((await result).refused.reason, new RegExp(`of ${count} steps were done: cancelled`));
}

async function applied(words) {
  const result = await client.command(words);
  assert.ok(result.applied, JSON.stringify([words, result]));
  return result.applied;
}

test("there are as many examples as are tried here", () => {
  assert.deepEqual(
    examples.map(({ kind }) => kind),
    ["sh", "json", "sh", "js", "js"],
  );
});

test("the words for a shell make the answer that is shown", async () => {
  const { text } = examples[0];
  const [, url, protocol] = /-c (\S+) -s (\S+)/.exec(here(text));
  const socket = new WebSocket(url, protocol);
  const answers = [];
  socket.on("message", (data, binary) => answers.push([binary, JSON.parse(data)]));
  await new Promise((resolve) => socket.on("open", resolve));
  for (const [, message] of text.matchAll(/-x '(.*)'/g)) socket.send(message);
  await until(() => answers.some(([, answer]) => answer.result));
  socket.close();
  assert.ok(answers.every(([binary]) => !binary));
  const shown = JSON.parse(examples[1].text);
  const { result } = answers.find(([, answer]) => answer.result)[1];
  assert.equal(result.id, shown.result.id);
  assert.match(result.applied.step ?? "0", /^\d+$/);
  assert.match(shown.result.applied.step, /^\d+$/);
  for (const kind of ["welcome", "scene", "settings"])
    assert.ok(
      answers.some(([, answer]) => answer[kind]),
      kind,
    );
});

test("ctl does the same and fails when it is refused", async () => {
  const [program, ...words] = here(examples[2].text).trim().split(" ");
  assert.equal(program, "spherule");
  const code = (more) =>
    new Promise((resolve) => execFile(process.env.SPHERULE, more, (error) => resolve(error?.code ?? 0)));
  assert.equal(await code(words), 0);
  assert.notEqual(await code([...words.slice(0, -1), "1e9"]), 0);
});

test("the figures of the world are said once a second", async () => {
  const lines = [];
  const timers = [];
  const sockets = [];
  class Socket extends WebSocket {
    constructor(...given) {
      super(...given);
      sockets.push(this);
    }
  }
  const run = new Function("WebSocket", "console", "setInterval", here(examples[3].text));
  const every = (task, ms) => timers.push(setInterval(task, ms / 10));
  run(Socket, { log: (line) => lines.push(line) }, every);
  await until(() => lines.length >= 3);
  timers.forEach(clearInterval);
  sockets.forEach((socket) => socket.close());
  for (const line of lines) assert.match(line, /^t = [\d.e-]+ s: \d+\.\d{3} m up on average, at most \d+\.\d{2} m\/s$/);
});

test("positions come out of a frame as is shown", async () => {
  const places = [
    [0.25, -0.5, 0.75],
    [-0.4, 0.1, 0.2],
    [0.1, 0.6, 0.3],
  ];
  const spheres = places.map((position) => ({ position }));
  await applied({ pause: {} });
  const groups = [{ radius: { constant: 0.05 }, list: { spheres } }];
  await applied({ load: { scene: { bounds: { min: [-1, -1, 0], max: [1, 1, 2] }, groups } } });
  const viewer = await connect({ rate: 30, tier: "FINE" });
  await until(() => viewer.heard.frame);
  viewer.socket.close();
  const { scene, order, frame } = viewer.heard;
  const { Decoder } = await loadDecoder();
  const ids = Buffer.from(order.ids, "base64");
  const run = new Function(
    "Decoder",
    "frame",
    "order",
    "boundsMin",
    "boundsMax",
    "k",
    `${examples[4].text}; return [id, z];`,
  );
  const one = (k) =>
    run(
      Decoder,
      { ...frame, spb: Buffer.from(frame.spb, "base64") },
      places.map((_, at) => ids.readUIntLE(3 * at, 3)),
      scene.boundsMin,
      scene.boundsMax,
      k,
    );
  const heights = new Map(places.map((_, k) => one(k)));
  places.forEach(([, , z], id) => assert.ok(Math.abs(heights.get(id) - z) <= frame.quantum / 2 + 1e-6));
});

/** Returns the range of a field in the table of commands. */
function rangeOf(field) {
  const row = documentText.split("\n").find((line) => line.startsWith(`| \`${field}\` |`));
  return row?.split("|")[3].trim();
}

/** Returns { set: { speed: value } } for the field "set.speed". */
const nested = (field, value) => field.split(".").reduceRight((inner, name) => ({ [name]: inner }), value);

for (const [field, range, within, outside] of [
  ["step.count", "1 to 100,000", [1, 100_000], [0, 100_001]],
  ["set.restitution", "0 to 1", [0, 1], [-0.001, 1.001]],
  ["set.friction", "0 to 100", [0, 100], [-0.001, 100.001]],
  ["set.auto.budgetMs", "above 0, to 60,000", [0.001, 60_000], [0, 60_001]],
  ["set.auto.overlap", "0.000001 to 0.5", [0.000001, 0.5], [0.0000009, 0.501]],
  ["set.speed", "0.001 to 1,000", [0.001, 1000], [0.0009, 1001]],
]) {
  test(`${field} has the range of the document`, async () => {
    assert.equal(rangeOf(field), range);
    for (const value of outside) {
      const { refused } = await client.command(nested(field, value));
      assert.match(refused.field, new RegExp(`${field.split(".").at(-1)}$`));
    }
    for (const value of within) await (field === "step.count" ? begun(value) : applied(nested(field, value)));
    await applied({ pause: {} });
    await applied({ set: { speed: 1, auto: {} } });
  });
}

test("vectors and targets have the ranges of the document", async () => {
  await applied({ set: { gravity: [0, 0, -1e6] } });
  const impulse = [0, 0, 1e-9];
  for (const [words, field] of [
    [{ set: { gravity: [0, 0, -1.01e6] } }, "gravity"],
    [{ set: { gravity: [0, 0] } }, "gravity"],
    [{ push: { sphere: 3, impulse } }, "sphere"],
    [{ push: { sphere: 0, impulse: [0, 0, 1.1e9] } }, "impulse"],
    [{ push: { ray: { origin: [0, 0, 1], direction: [0, 0, 0] }, impulse } }, "direction"],
    [{ set: { substeps: 0 } }, "substeps"],
    [{ seek: { time: 1 } }, ""], // a server that simulates has no timeline
  ]) {
    const { refused } = await client.command(words);
    assert.ok((refused.field ?? "").includes(field), JSON.stringify([words, refused]));
  }
  assert.equal((await applied({ push: { sphere: 2, impulse } })).sphere, "2");
});

test("load keeps what the document says, and nothing else", async () => {
  await applied({ startRecording: {} });
  await applied({
    set: { speed: 2, gravity: [0, 0, -1], restitution: 0.25, friction: 0.5, model: "FAST", substeps: 3 },
  });
  await applied({ pause: {} });
  await until(() => client.heard.settings.paused && client.heard.recording?.active);
  const { epoch } = client.heard.scene;
  const { file } = client.heard.recording;

  const refused = await client.command({ load: { name: "no such scene" } });
  assert.match(refused.refused.field, /name$/);
  assert.equal(client.heard.scene.epoch, epoch);
  assert.equal(client.heard.settings.substeps, 3);

  assert.equal((await applied({ load: { name: "bounce" } })).step ?? "0", "0");
  await until(() => client.heard.scene.epoch > epoch);
  assert.equal(client.heard.scene.name, "bounce");
  const { speed, paused, gravity, restitution, friction = 0, model, substeps } = client.heard.settings;
  assert.deepEqual([speed, paused], [2, true]);
  assert.deepEqual([gravity, restitution, friction, model], [[0, 0, -9.81], 0.8, 0, "BALANCED"]);
  assert.notEqual(substeps, 3);
  const { statistics } = await applied({ query: {} });
  assert.deepEqual([statistics.step ?? "0", statistics.simTime ?? 0, statistics.spheres], ["0", 0, 1]);
  assert.deepEqual([client.heard.recording.active, client.heard.recording.file], [true, file]);
  await applied({ stopRecording: {} });

  // Reset restores the loaded scene, except the speed.
  await applied({ set: { gravity: [0, 0, -2] } });
  await applied({ reset: {} });
  await until(() => client.heard.settings.gravity[2] === -9.81);
  assert.equal(client.heard.settings.speed, 2);
});
