// The real server, started for a test on a port of its own.
import { spawn, execFile } from "node:child_process";
import path from "node:path";

const binary = path.resolve(process.env.SPHERULE ?? "build/release/spherule");

const running = new Set();

/** Ends what a failed test left behind; its file would wait for it otherwise. */
export async function stopAll() {
  await Promise.all([...running].map((server) => server.stop()));
}

/** Runs the program to its end; returns what it printed, or throws with what it complained about. */
export function spherule(...words) {
  return run(words, {});
}

function run(words, more) {
  return new Promise((resolve, reject) => {
    execFile(binary, words, { env: { ...process.env, ...more } }, (error, out, err) => (error ? reject(new Error(err)) : resolve(out)));
  });
}

/** Serves the scene; `port` 0 takes a free one. `more`: as for start(). */
export function serve(scene, { port = 0, device = "cpu", ...more } = {}) {
  return start(["serve", scene, "--device", device, "--listen", `127.0.0.1:${port}`], more);
}

/** Plays the recording. `more`: as for start(). */
export function play(file, more = {}) {
  return start(["play", file, "--listen", "127.0.0.1:0"], more);
}

/**
 * `folder`: where it runs. `options`: more of the command line. `tokens`: { viewer, controller }; without, everybody steers.
 * `settings`: more environment variables.
 */
async function start(words, { folder, options = [], tokens = {}, settings = {} }) {
  const { viewer = "", controller = "" } = tokens;
  const env = { ...process.env, SPHERULE_VIEWER_TOKEN: viewer, SPHERULE_CONTROLLER_TOKEN: controller, ...settings };
  const child = spawn(binary, [...words, ...options], { cwd: folder, env, stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  child.stderr.on("data", (data) => (said += data));
  const ended = new Promise((resolve) => child.once("exit", resolve));
  const url = await new Promise((resolve, reject) => {
    child.stdout.on("data", (data) => {
      said += data;
      const address = /open (https?:\S+)/.exec(said)?.[1];
      if (address) resolve(address);
    });
    void ended.then((code) => reject(new Error(`the server ended with ${code}:\n${said}`)));
  });
  const server = {
    url,
    port: Number(new URL(url).port),
    /** Gives a command as a shell would; returns what ctl printed, or throws when it was refused. */
    ctl(...words) {
      return run(["ctl", `${url.replace("http", "ws")}ws`, ...words], { SPHERULE_TOKEN: controller });
    },
    /** Its exit code, once it has ended by itself. */
    async ended() {
      const code = await ended;
      running.delete(server);
      return code;
    },
    /** Ends it as the kernel does that needs memory: it can do nothing more. */
    async kill() {
      running.delete(server);
      child.kill("SIGKILL");
      await ended;
    },
    /** It stands still, with all its connections open, until it is thawed. */
    freeze: () => child.kill("SIGSTOP"),
    thaw: () => child.kill("SIGCONT"),
    /** The value of a metric, as `name` or `name{label="value"}`; undefined: there is none. */
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
      if (code !== 0) throw new Error(`the server ended with ${code}:\n${said}`);
    },
  };
  running.add(server);
  return server;
}
