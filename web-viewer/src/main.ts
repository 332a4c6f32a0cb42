import { withoutToken } from "./connection/admission";
import { loadViewRequest } from "./connection/view_request";
import { Choices } from "./ui/choices";
import type { FirstChoices } from "./ui/choices";
import { modes } from "./model/quantities";
import { createTestApi } from "./test_api";
import { showFailure, watchForFailures } from "./ui/failure";
import { systemTheme } from "./ui/system_theme";
import { Viewer } from "./viewer";

/** Reads a choice from an address: ?colour=group&picture=full&theme=dark&tier=fine&rate=10&fixed */
function chosen<T extends string>(address: URLSearchParams, name: string, allowed: readonly T[]): T | undefined {
  const value = address.get(name);
  return allowed.find((candidate) => candidate === value);
}

/**
 * Starts the viewer of an element. Its attribute data-server is the address of a stream, with the viewer's choices as
 * parameters; without it, the address is "ws". `own`: see Site.
 */
function start(host: HTMLElement, own: boolean): Viewer {
  const url = new URL(host.dataset.server ?? "ws", location.href);
  const address = own ? new URLSearchParams(location.search) : url.searchParams;
  const clean = own ? withoutToken(location.href) : undefined;
  if (clean !== undefined) history.replaceState(history.state, "", clean);
  const first: FirstChoices = {
    mode: chosen(address, "colour", modes),
    theme: chosen(address, "theme", ["light", "dark"]),
    quality: chosen(address, "picture", ["auto", "full", "light"]) ?? "auto",
    view: loadViewRequest(address, () => localStorage),
  };
  const choices = new Choices(first, systemTheme());
  url.protocol = url.protocol.replace("http", "ws");
  url.search = url.hash = "";
  const viewer = new Viewer(host, choices, url.href, own);
  viewer.start(clean !== undefined);
  return viewer;
}

try {
  const viewers = Array.from(document.querySelectorAll<HTMLElement>(".spherule"), (host, k) => start(host, k === 0));
  if (!viewers[0]) throw new Error('The page has no element of the class "spherule".');
  window.spherule = createTestApi(viewers[0]);
  watchForFailures();
} catch (error) {
  showFailure(error, true);
  throw error;
}
