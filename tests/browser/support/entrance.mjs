// Access to a server that requires a token: through the page, and as a minimal client.
import { WebSocket } from "ws";
import { control, shows, visit } from "./browser.mjs";

export const tokens = { viewer: "the-viewers-token-of-a-test", controller: "the-controllers-token-of-a-test" };
export const prompt = `${control("token-prompt")}[open]`;

/** Enters the token in the dialog. */
export async function give(page, token) {
  await page.waitForSelector(prompt);
  await page.fill(control("token-field"), token);
  await page.press(control("token-field"), "Enter");
}

/** Opens the page, and enters the token. */
export async function enter(browser, server, token, options) {
  const page = await visit(browser, server.url, options);
  await give(page, token);
  await shows(page);
  return page;
}

/** Connects a controller with this name that requests control. */
export async function join(server, name) {
  const socket = new WebSocket(`${server.url.replace("http", "ws")}ws`, "spherule.v1");
  const send = (message) => socket.send(JSON.stringify(message));
  await new Promise((resolve, reject) => socket.once("open", resolve).once("error", reject));
  send({ hello: { client: name, token: tokens.controller, view: { rate: 0 } } });
  await new Promise((resolve) => socket.once("message", resolve));
  send({ askControl: {} });
  return socket;
}
