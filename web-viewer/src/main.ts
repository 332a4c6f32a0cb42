import { withoutToken } from "./connection/admission";
import { loadViewRequest } from "./connection/view_request";
import { Cut } from "./model/cut";
import { modes } from "./model/quantities";
import { createTestApi } from "./test_api";
import { showFailure, watchForFailures } from "./ui/failure";
import type { Choices } from "./ui/panel";
import { systemTheme } from "./ui/system_theme";
import { Viewer } from "./viewer";

/** Reads a choice from the address: ?colour=group&picture=full&theme=dark&tier=fine&rate=10&fixed */
function chosen<T extends string>(name: string, allowed: readonly T[]): T | undefined {
  const value = new URLSearchParams(location.search).get(name);
  return allowed.find((candidate) => candidate === value);
}

function serverUrl(): string {
  const url = new URL("ws", location.href);
  url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  url.search = url.hash = "";
  return url.href;
}

function start(): void {
  const canvas = document.querySelector<HTMLCanvasElement>("#picture");
  const container = document.querySelector<HTMLElement>("#page");
  if (!canvas || !container) throw new Error("The page has no canvas.");
  const clean = withoutToken(location.href);
  if (clean !== undefined) history.replaceState(history.state, "", clean);
  const mode = chosen("colour", modes);
  const theme = chosen("theme", ["light", "dark"]);
  const choices: Choices = {
    cut: new Cut(),
    trace: true,
    mode: mode ?? "speed",
    modeChosen: mode !== undefined,
    rotation: "auto",
    quality: chosen("picture", ["auto", "full", "light"]) ?? "auto",
    theme: theme ?? systemTheme(),
    themeChosen: theme !== undefined,
    tool: "select",
    impulse: 1,
    view: loadViewRequest(new URLSearchParams(location.search), () => localStorage),
  };
  const viewer = new Viewer(canvas, container, choices, serverUrl());
  window.spherule = createTestApi(viewer);
  viewer.start(clean !== undefined);
}

try {
  start();
  watchForFailures();
} catch (error) {
  showFailure(error, true);
  throw error;
}
