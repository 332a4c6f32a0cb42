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
  return new Promise((resolve, reject) => {
    execFile(binary, words, (error, out, err) => (error ? reject(new Error(err)) : resolve(out)));
  });
}

/** Serves the scene; `port` 0 takes a free one. `folder`: where it runs. `settings`: environment variables. */
export function serve(scene, { port = 0, device = "cpu", folder, settings } = {}) {
  return start(["serve", scene, "--device", device, "--listen", `127.0.0.1:${port}`], folder, settings);
}

/** Plays the recording. */
export function play(file, ...options) {
  return start(["play", file, "--listen", "127.0.0.1:0", ...options]);
}

async function start(words, folder, settings) {
  const env = { ...process.env, ...settings };
  const child = spawn(binary, words, { cwd: folder, env, stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  child.stderr.on("data", (data) => (said += data));
  const ended = new Promise((resolve) => child.once("exit", resolve));
  const url = await new Promise((resolve, reject) => {
    child.stdout.on("data", (data) => {
      said += data;
      const address = /open (http:\S+)/.exec(said)?.[1];
      if (address) resolve(address);
    });
    void ended.then((code) => reject(new Error(`the server ended with ${code}:\n${said}`)));
  });
  const server = {
    url,
    port: Number(new URL(url).port),
    /** Gives a command as a shell would; returns what ctl printed, or throws when it was refused. */
    ctl(...words) {
      return spherule("ctl", url.replace("http:", "ws:") + "ws", ...words);
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
      const text = await (await fetch(`${url}metrics`)).text();
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
