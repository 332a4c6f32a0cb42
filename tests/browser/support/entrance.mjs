// Coming into a server that asks for a token: by the page, and as a client that has only a name.
import { WebSocket } from "ws";
import { control, shows, visit, when } from "./browser.mjs";

export const tokens = { viewer: "the-viewers-token-of-a-test", controller: "the-controllers-token-of-a-test" };
export const prompt = `${control("token-prompt")}[open]`;

/** Types the token and presses Enter. */
export async function give(page, token) {
  await page.waitForSelector(prompt);
  await page.fill(control("token-field"), token);
  await page.press(control("token-field"), "Enter");
}

/** A page that has been let in with the token. */
export async function enter(browser, server, token, options) {
  const page = await visit(browser, server.url, options);
  await give(page, token);
  await shows(page);
  return page;
}

/** Waits until what the element says is like that. */
export async function says(page, id, pattern) {
  await when(page, ([name, source]) => new RegExp(source).test(document.querySelector(`[data-testid="${name}"]`)?.textContent), [id, pattern.source]);
}

/** A controller that asks for the controls, and gets them if nobody has them. */
export async function join(server, name) {
  const socket = new WebSocket(`${server.url.replace("http", "ws")}ws`, "spherule.v1");
  const say = (message) => socket.send(JSON.stringify(message));
  await new Promise((resolve, reject) => socket.once("open", resolve).once("error", reject));
  say({ hello: { client: name, token: tokens.controller, view: { rate: 0 } } });
  await new Promise((resolve) => socket.once("message", resolve));
  say({ askControl: {} });
  return socket;
}
