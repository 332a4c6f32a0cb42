import type { LinkState } from "../connection/messages";

/**
 * The page is in one of these situations at a time.
 * - `connecting`: for the first time; no scene is known yet.
 * - `waiting`: connected, but the scene has not arrived.
 * - `live`: pictures and figures are current. `empty`: and the scene has no spheres.
 * - `silent`: connected, but the server does not answer.
 * - `offline`: there is no connection; the page tries again. `refused`: because the server refused this page.
 * - `ended`: the server said that it stops. `lost`: that its device is lost. The page tries again.
 * - `locked`: the server requires a token.
 */
export type Situation =
  "connecting" | "waiting" | "live" | "empty" | "silent" | "offline" | "refused" | "ended" | "lost" | "locked";

/** Whether the page can draw. `lost`: the browser has taken the WebGL context away. `none`: there is no WebGL 2. */
export type Graphics = "ok" | "lost" | "none";

/** The part of a session that determines the state of the page. */
export interface Circumstances {
  connection: LinkState | "silent";
  attempted: boolean; // an attempt to connect has failed, or a connection has ended
  refusal: string; // why the server refused this page; empty if it did not
  farewell: string; // why the server ended; empty once a server answers
  deviceLost: boolean; // with `farewell`: the device of the server is lost
  spheres: number | undefined; // in the scene; undefined: no scene is known yet
}

/** The rules of this state for all parts of the page. */
export interface PageState {
  situation: Situation;
  /** Pictures and figures are current. If not, the page shows them as old, or not at all. */
  current: boolean;
  /** Why no command can be sent; empty if the connection allows it. */
  blockedReason: string;
}

const reasons: Record<Situation, string> = {
  connecting: "Not connected yet",
  waiting: "The scene has not arrived yet",
  live: "",
  empty: "",
  silent: "The server does not answer",
  offline: "There is no connection to the server",
  refused: "The server has refused this page",
  ended: "The server has ended",
  lost: "The server has ended",
  locked: "The server requires a token",
};

export function pageStateOf(circumstances: Circumstances): PageState {
  const situation = situationOf(circumstances);
  const current = situation === "live" || situation === "empty";
  return { situation, current, blockedReason: reasons[situation] };
}

function situationOf({ connection, attempted, refusal, farewell, deviceLost, spheres }: Circumstances): Situation {
  if (connection === "locked") return "locked";
  if (farewell) return deviceLost ? "lost" : "ended";
  if (connection === "waiting" || connection === "connecting") {
    if (refusal) return "refused";
    return connection === "waiting" || attempted ? "offline" : "connecting";
  }
  if (connection === "silent") return "silent";
  if (spheres === undefined) return "waiting";
  return spheres > 0 ? "live" : "empty";
}
