// The real server, started by a test on a port of its own.
import { spawn, execFile } from "node:child_process";
import path from "node:path";

const binary = path.resolve(process.env.SPHERULE ?? "build/release/spherule");

const running = new Set();

/** Stops the servers that a failed test has left running: its file would otherwise not end. */
export async function stopAll() {
  await Promise.all([...running].map((server) => server.stop()));
}

/** Runs the program to its end. Returns its output, or throws an Error with its error output. */
export function spherule(...words) {
  return run(words, {});
}

function run(words, more) {
  return new Promise((resolve, reject) => {
    const env = { ...process.env, ...more };
    execFile(binary, words, { env }, (error, out, err) => (error ? reject(new Error(err)) : resolve(out)));
  });
}

/** Serves the scene. `port`: 0 for a free one; `more`: as for start(). */
export function serve(scene, { port = 0, device = "cpu", ...more } = {}) {
  return start(["serve", scene, "--device", device, "--listen", `127.0.0.1:${port}`], more);
}

/** Plays the recording. `more`: as for start(). */
export function play(file, more = {}) {
  return start(["play", file, "--listen", "127.0.0.1:0"], more);
}

/**
 * `folder`: working directory. `options`: further options of the command line. `tokens`: { viewer, controller };
 * without them, every client may send commands. `settings`: further environment variables.
 */
async function start(words, { folder, options = [], tokens = {}, settings = {} }) {
  const { viewer = "", controller = "" } = tokens;
  const env = { ...process.env, SPHERULE_VIEWER_TOKEN: viewer, SPHERULE_CONTROLLER_TOKEN: controller, ...settings };
  const child = spawn(binary, [...words, ...options], { cwd: folder, env, stdio: ["ignore", "pipe", "pipe"] });
  let output = "";
  child.stderr.on("data", (data) => (output += data));
  const ended = new Promise((resolve) => child.once("exit", resolve));
  const url = await new Promise((resolve, reject) => {
    child.stdout.on("data", (data) => {
      output += data;
      const address = /open (https?:\S+)/.exec(output)?.[1];
      if (address) resolve(address);
    });
    void ended.then((code) => reject(new Error(`the server ended with ${code}:\n${output}`)));
  });
  const server = {
    url,
    port: Number(new URL(url).port),
    /** Sends a command with `spherule ctl`. Returns its output, or throws an Error if the command was refused. */
    ctl(...words) {
      return run(["ctl", `${url.replace("http", "ws")}ws`, ...words], { SPHERULE_TOKEN: controller });
    },
    /** Waits until the server has ended by itself; returns its exit code. */
    async ended() {
      const code = await ended;
      running.delete(server);
      return code;
    },
    /** Kills the server with SIGKILL. */
    async kill() {
      running.delete(server);
      child.kill("SIGKILL");
      await ended;
    },
    /** Suspends the server, with its connections open, until thaw() is called. */
    freeze: () => child.kill("SIGSTOP"),
    thaw: () => child.kill("SIGCONT"),
    /** Returns the value of a metric, given as `name` or `name{label="value"}`; undefined if it does not exist. */
    async metric(name) {
      const headers = { Authorization: `Bearer ${controller || viewer}` };
      const text = await (await fetch(`${url}metrics`, { headers })).text();
      const line = text.split("\n").find((one) => one.startsWith(`${name} `));
      return line && Number(line.slice(name.length));
    },
    async stop() {
      running.delete(server);
      child.kill("SIGTERM");
      child.kill("SIGCONT"); // a failed test may have left it frozen
      const code = await ended;
      if (code !== 0) throw new Error(`the server ended with ${code}:\n${output}`);
    },
  };
  running.add(server);
  return server;
}
