// Brings the page into each of its states: for pictures of all of them.
import { writeFileSync } from "node:fs";
import path from "node:path";
import { clickSphere, control, open, pause, unfold, visit, when } from "./browser.mjs";
import { enter, give, join, prompt, tokens } from "./entrance.mjs";
import { showPanel } from "./layout.mjs";
import { play, serve, spherule } from "./server.mjs";

// Events of the server that a test cannot cause at will; as in Event.Kind of control.proto.
const nonFinite = 2;
const deviceLost = 5;

const noWebGl = () => {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return kind === "webgl2" ? null : getContext.call(this, kind, ...more);
  };
};

/** Opens a page of its own server. `more`: of the page; `paused`: the world stands still at its beginning. */
async function shown(browser, scene, { paused = true, ...more } = {}) {
  const server = await serve(scene);
  if (paused) for (const command of ["pause", "reset"]) await server.ctl(command);
  const page = await open(browser, server.url, { reducedMotion: "reduce", ...more });
  return { server, page };
}

/** A state of the cradle, paused. `arrange(page, server)` runs before each picture, `once` before the first one. */
function cradle({ once = () => {}, arrange = () => {} }) {
  return async ({ browser }) => {
    const { server, page } = await shown(browser, "cradle");
    await once(page, server);
    return { page, arrange: () => arrange(page, server) };
  };
}

/** The panel, scrolled to this share of its length. */
function panel(share) {
  const arrange = async (page) => {
    await showPanel(page, true);
    await page.evaluate((at) => {
      const list = document.querySelector(".panel .folders");
      list.scrollTop = at * (list.scrollHeight - list.clientHeight);
    }, share);
  };
  return cradle({ arrange });
}

/** A dialog that a control of the panel opens. */
function dialog(button, id, fill = () => {}) {
  const once = async (page) => {
    await showPanel(page, true);
    await page.click(control(button));
    await page.waitForSelector(`${control(id)}[open]`);
    await fill(page);
  };
  return cradle({ once });
}

/** Clicks on the sphere in the middle, with the camera at home. `tool`: chosen first. */
async function select(page, tool) {
  await page.setViewportSize({ width: 1280, height: 720 });
  await showPanel(page, true);
  if (tool) await page.selectOption(control("tool"), tool);
  await clickSphere(page, 2);
  await when(page, () => spherule.selected === 2);
}

async function enterWrong(page, id) {
  await showPanel(page, true);
  await page.fill(control(id), "1.01");
  await page.press(control(id), "Enter");
  await page.locator(control(id)).scrollIntoViewIfNeeded();
}

const notice = (page, id) => page.waitForSelector(`[data-notice="${id}"]`);

/** The page receives an event of this kind. */
const receive = (page, kind, text) =>
  page.evaluate((event) => spherule.session.handle({ kind: "event", event }), { kind, text });

/** The page of a server of its own. `workerOf(response, server)` returns what differs in the worker that it gets. */
async function withWorker(browser, workerOf) {
  const server = await serve("cradle");
  const page = await browser.newPage();
  await page.route("**/worker.js", async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, ...(await workerOf(response, server)) });
  });
  return { server, page };
}

/**
 * Each function brings a page into a state, and returns the page, `arrange`, which runs before each picture, and `end`.
 * It is given the browser and a folder for files.
 */
export const states = {
  live: async ({ browser }) => {
    const { page } = await shown(browser, "billiards", { paused: false });
    return { page };
  },
  "panel-hidden": cradle({ arrange: (page) => showPanel(page, false) }),
  "panel-top": panel(0),
  "panel-middle": panel(0.5),
  "panel-end": panel(1),
  gallery: dialog("scenes", "gallery"),
  help: cradle({ once: (page) => page.keyboard.press("?") }),
  editor: dialog("edit-scene", "editor", async (page) => {
    await page.keyboard.press("Control+A");
    await page.keyboard.insertText('{\n  "bounds": {"min": [0, 0, 0], "max": [1, 1, 1]},\n  "grops": []\n}');
    await page.click(control("editor-load"));
    await when(page, (id) => document.querySelector(id).textContent !== "", control("editor-message"));
  }),
  token: async ({ browser }) => {
    const page = await visit(browser, (await serve("cradle", { tokens })).url);
    await give(page, "wrong");
    await when(page, (id) => document.querySelector(id).textContent !== "", control("token-wrong"));
    return { page };
  },
  locked: async ({ browser }) => {
    const page = await visit(browser, (await serve("cradle", { tokens })).url);
    await page.waitForSelector(prompt);
    await page.keyboard.press("Escape");
    await notice(page, "locked");
    return { page };
  },
  selected: cradle({ once: (page) => select(page), arrange: (page) => showPanel(page, false) }),
  charts: cradle({
    once: async (page) => {
      await showPanel(page, true);
      await unfold(page, "Charts");
      await page.waitForSelector(`${control("chart-image")} canvas`);
      await page.click(control("pause"));
      await when(page, () => spherule.session.samples.list.length > 4);
      await pause(page);
    },
    arrange: async (page) => {
      await showPanel(page, true);
      await page.locator(control("chart-image")).scrollIntoViewIfNeeded();
    },
  }),
  drop: cradle({
    once: async (page) => {
      await showPanel(page, true);
      await page.selectOption(control("tool"), "Drop");
    },
    arrange: async (page) => {
      await showPanel(page, false);
      const { x, y, width, height } = await page.locator(control("picture")).boundingBox();
      await page.mouse.move(x + width / 2, y + height / 2);
    },
  }),
  pull: cradle({
    once: async (page) => {
      await select(page, "Pull");
      await page.focus(control("picture"));
      await page.keyboard.press("ArrowUp");
      await page.waitForSelector(control("pull-force"));
    },
  }),
  gravity: cradle({
    arrange: async (page) => {
      await showPanel(page, true);
      await page.mouse.move(10, 10); // the page loads the tools
      await page.locator(control("gravity-arrow")).scrollIntoViewIfNeeded();
    },
  }),
  toasts: cradle({
    arrange: async (page, server) => {
      await showPanel(page, true);
      await page.fill(control("drop-count"), "16000");
      await page.press(control("drop-count"), "Enter");
      await page.click(control("drop")); // too many: a toast with details
      await page.waitForSelector(`${control("toast")}[data-tone="bad"]`);
      await showPanel(page, false);
      await server.ctl("set", "friction", "0.1");
      await page.keyboard.press("r");
      await page.waitForSelector(`${control("toast")}[data-tone="plain"]`);
      await page.waitForSelector(`${control("toast")}[data-tone="good"]`);
    },
  }),
  wrong: cradle({ arrange: (page) => enterWrong(page, "restitution") }),
  recording: async ({ browser, folder }) => {
    const file = path.join(folder, "cradle.sph");
    await spherule("run", "cradle", "--for", "2s", "--record", file, "--device", "cpu");
    const server = await play(file, { options: ["--paused"] });
    await server.ctl("seek", "1");
    return { page: await open(browser, server.url) };
  },
  past: async ({ browser }) => {
    const { page } = await shown(browser, "cradle", { paused: false });
    await when(page, () => spherule.session.past?.end - spherule.session.past?.begin >= 3);
    const { x, y, width, height } = await page.locator(control("timeline")).boundingBox();
    await page.mouse.click(x + width / 2, y + height / 2);
    await when(page, () => spherule.session.replay?.source === "past" && !spherule.seeking);
    await page.keyboard.press("Space"); // the past stands still
    return { page };
  },
  paused: cradle({}),
  diverged: cradle({
    once: async (page) => {
      await receive(page, nonFinite, "sphere 2 has no finite position any more");
      await notice(page, "diverged");
    },
  }),
  outside: async ({ browser }) => {
    const { server, page } = await shown(browser, "two-spheres", { paused: false });
    await server.ctl("set", "speed", "20");
    await notice(page, "outside");
    return { page };
  },
  empty: async ({ browser, folder }) => {
    const file = path.join(folder, "empty.json");
    writeFileSync(file, JSON.stringify({ name: "empty", bounds: { min: [-1, -1, 0], max: [1, 1, 2] } }));
    const page = await visit(browser, (await serve(file)).url);
    await notice(page, "empty");
    return { page };
  },
  connecting: async ({ browser }) => {
    const { server, page } = await withWorker(browser, async (response) => ({
      body: `self.WebSocket = class { close() {} }; ${await response.text()}`, // never opens
    }));
    // The page gives up after 10 s, so each picture is of a new visit.
    const arrange = async () => {
      await page.goto(server.url);
      await notice(page, "connecting");
    };
    return { page, arrange };
  },
  unreachable: async ({ browser }) => {
    const { server, page } = await withWorker(browser, (_, { kill }) => kill());
    await page.goto(server.url);
    await notice(page, "offline");
    return { page };
  },
  silent: cradle({
    once: async (page, server) => {
      server.freeze();
      await notice(page, "silent");
    },
  }),
  offline: cradle({
    once: async (page, server) => {
      await server.kill();
      await notice(page, "offline");
    },
  }),
  refused: async ({ browser }) => {
    const small = await serve("cradle", { options: ["--max-sessions", "1"] });
    await open(browser, small.url);
    const page = await visit(browser, small.url);
    await notice(page, "refused");
    return { page };
  },
  ended: cradle({
    once: async (page, server) => {
      await server.stop();
      await notice(page, "ended");
    },
  }),
  lost: cradle({
    once: async (page, server) => {
      await receive(page, deviceLost, "The simulation has ended (device 0 was reset): this page goes on by itself.");
      await server.kill();
      await notice(page, "lost");
    },
  }),
  "no-webgl": async ({ browser }) => {
    const page = await visit(browser, (await serve("cradle")).url, { init: noWebGl });
    await notice(page, "no-graphics");
    return { page };
  },
  "context-lost": cradle({
    once: async (page) => {
      await page.evaluate(() =>
        document.querySelector("canvas").getContext("webgl2").getExtension("WEBGL_lose_context").loseContext(),
      );
      await notice(page, "graphics-lost");
    },
  }),
  failure: cradle({
    once: async (page) => {
      await page.evaluate(() => void setTimeout(() => Promise.reject(new Error("something is undefined"))));
      await page.waitForSelector(control("failure"));
    },
  }),
  watching: async ({ browser }) => {
    const page = await enter(browser, await serve("cradle", { tokens }), tokens.viewer);
    return { page };
  },
  controlled: async ({ browser }) => {
    const server = await serve("cradle", { tokens });
    const other = await join(server, "Ada Lovelace");
    other.send(JSON.stringify({ command: { id: 1, pause: {} } })); // takes control
    const page = await enter(browser, server, tokens.controller);
    await page.waitForSelector(`${control("control")}[data-state="taken"]`, { state: "attached" });
    return { page, end: () => other.close() };
  },
  requested: async ({ browser }) => {
    const server = await serve("cradle", { tokens });
    const page = await enter(browser, server, tokens.controller);
    await page.click(control("pause"));
    await page.waitForSelector(`${control("control")}[data-state="mine"]`, { state: "attached" });
    const others = [await join(server, "Ada Lovelace"), await join(server, "Charles Babbage")];
    await page.waitForSelector(control("control-hand-over"));
    return { page, end: () => others.forEach((other) => other.close()) };
  },
  groups: async ({ browser }) => {
    const { page } = await shown(browser, "billiards", { colour: "group" });
    return { page };
  },
};
