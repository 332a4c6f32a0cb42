// A server's admission in small, before a real server that lets in everybody: tokens, roles, the controls that one controller has
// at a time. It serves the built page with the policy that the server sends, and knows by PAGE where that is.
import { readFileSync } from "node:fs";
import http from "node:http";
import path from "node:path";
import { WebSocket, WebSocketServer } from "ws";
import { loadMessages } from "../../../web-viewer/tools/module.mjs";

const { ClientMessageSchema, ServerMessageSchema, Role, create, fromBinary, toBinary } = await loadMessages();
const { VIEWER, CONTROLLER } = Role;
const folder = path.resolve(process.env.PAGE ?? "build/release/web-viewer/dist");
const types = { html: "text/html", js: "text/javascript", css: "text/css", svg: "image/svg+xml" };
const policy =
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; worker-src 'self'; " +
  "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const open = new Set();

/** `tokens`: for a viewer and for a controller; neither: everybody steers. */
export async function gateTo(server, { viewer = "", controller = "" } = {}) {
  const gate = new Gate(server, { viewer, controller });
  await gate.listen();
  open.add(gate);
  return gate;
}

/** Closes what a failed test left behind. */
export async function closeGates() {
  await Promise.all([...open].map((gate) => gate.close()));
}

class Gate {
  /** Names of the commands that were let through. */
  passed = [];
  /** Instead of a welcome: { code, reason }. */
  refusal = undefined;
  #clients = [];
  #holder = undefined;
  #asking = [];
  #sessions = 0;
  #http = http.createServer((request, response) => this.#serve(request, response));

  constructor(server, tokens) {
    this.server = server;
    this.tokens = tokens;
  }

  async listen() {
    const sockets = new WebSocketServer({ server: this.#http, path: "/ws" });
    sockets.on("connection", (socket) => this.#taken(socket));
    await new Promise((resolve) => this.#http.listen(0, "127.0.0.1", resolve));
    this.url = `http://127.0.0.1:${this.#http.address().port}/`;
  }

  async close() {
    open.delete(this);
    this.drop();
    this.#http.closeAllConnections();
    await new Promise((resolve) => this.#http.close(resolve));
  }

  /** Closes all connections as a server does that is started anew. */
  drop() {
    for (const { socket } of this.#clients) socket.close(1012, "restart");
  }

  /** A client that has only a name: lets itself in and gives a command, so that it has the controls if nobody has. */
  async join(name) {
    const socket = new WebSocket(`${this.url.replace("http", "ws")}ws`, "spherule.v1");
    const say = (kind) => socket.send(toBinary(ClientMessageSchema, create(ClientMessageSchema, { kind })));
    await new Promise((resolve) => socket.once("open", resolve));
    say({ case: "hello", value: { client: name, token: this.tokens.controller } });
    await new Promise((resolve) => socket.once("message", resolve));
    say({ case: "askControl", value: {} });
    return socket;
  }

  #serve(request, response) {
    const name = new URL(request.url, this.url).pathname.slice(1) || "index.html";
    try {
      const body = readFileSync(path.join(folder, path.basename(name)));
      response.writeHead(200, { "Content-Type": types[name.split(".").at(-1)], "Content-Security-Policy": policy, "Cache-Control": "no-store" });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  }

  #roleFor(token) {
    const { viewer, controller } = this.tokens;
    if (!viewer && !controller) return CONTROLLER;
    return token && { [viewer]: VIEWER, [controller]: CONTROLLER }[token];
  }

  #taken(socket) {
    socket.once("message", (data) => {
      const hello = fromBinary(ClientMessageSchema, data).kind.value;
      const role = this.#roleFor(hello.token);
      if (this.refusal) socket.close(this.refusal.code, this.refusal.reason);
      else if (role) this.#letIn(socket, hello, role);
      else if (!hello.token) socket.close(4401, "this server asks for a token");
      else setTimeout(() => socket.close(4401, "this token is not known here"), 300);
    });
  }

  #letIn(socket, hello, role) {
    const client = { socket, role, name: hello.client, session: BigInt(++this.#sessions) };
    client.real = new WebSocket(`${this.server.url.replace("http", "ws")}ws`, "spherule.v1");
    const ready = new Promise((resolve) => client.real.once("open", resolve));
    client.pass = (message) => void ready.then(() => client.real.send(message));
    client.pass(toBinary(ClientMessageSchema, create(ClientMessageSchema, { kind: { case: "hello", value: { ...hello, token: "" } } })));
    client.real.once("message", (data) => {
      const { value } = fromBinary(ServerMessageSchema, data).kind;
      this.#say(client, { case: "welcome", value: { ...value, role, session: client.session } });
      this.#tell(client);
      client.real.on("message", (more) => socket.send(more));
    });
    client.real.on("close", () => socket.close());
    this.#clients.push(client);
    socket.on("message", (data) => this.#heard(client, data));
    socket.on("close", () => {
      client.real.close();
      this.#clients = this.#clients.filter((one) => one !== client);
      this.#move(this.#holder === client ? undefined : this.#holder, this.#asking.filter((one) => one !== client));
    });
  }

  #heard(client, data) {
    const { case: what, value } = fromBinary(ClientMessageSchema, data).kind;
    const holds = this.#holder === client;
    if (what === "command") this.#command(client, value, data);
    else if (what === "askControl") {
      if (!this.#holder) this.#move(client, this.#asking);
      else if (!holds && !this.#asking.includes(client)) this.#move(this.#holder, [...this.#asking, client]);
    } else if (what === "yieldControl") {
      const next = holds ? this.#asking.find(({ session }) => session === value.session) : client;
      this.#move(holds ? next : this.#holder, this.#asking.filter((one) => one !== next));
    } else if (what === "keepControl") {
      if (holds) this.#move(client, []);
    } else client.pass(data);
  }

  #command(client, { id, kind }, data) {
    const refuse = (reason) => this.#say(client, { case: "result", value: { id, outcome: { case: "refused", value: { reason } } } });
    if (client.role === VIEWER && kind.case !== "query") return refuse("a viewer may only watch");
    if (this.#leases && this.#holder && this.#holder !== client) return refuse(`${this.#holder.name} has the controls`);
    if (this.#leases && !this.#holder) this.#move(client, this.#asking.filter((one) => one !== client));
    this.passed.push(kind.case);
    client.pass(data);
  }

  get #leases() {
    return this.tokens.controller !== "";
  }

  #move(holder, asking) {
    this.#holder = holder;
    this.#asking = asking;
    for (const client of this.#clients) this.#tell(client);
  }

  #tell(client) {
    if (!this.#leases) return;
    const person = ({ session, name }) => ({ session, client: name });
    const holder = this.#holder && person(this.#holder);
    this.#say(client, { case: "control", value: { holder, asking: this.#asking.map(person) } });
  }

  #say({ socket }, kind) {
    if (socket.readyState === WebSocket.OPEN) socket.send(toBinary(ServerMessageSchema, create(ServerMessageSchema, { kind })));
  }
}
