import type { LinkChange } from "./messages";
import type { TokenStore } from "./token_store";

export interface AdmissionEvents {
  /** The server requires a token. `error`: why it rejected the last one; empty if it was given none. */
  tokenRequired(error: string): void;
  /** The token dialog can be closed. */
  tokenSettled(): void;
  /** Reconnect with this token, or without one if it is empty. */
  reconnect(token: string): void;
  /** Reports whether this tab remembers a token. */
  tokenHeld(held: boolean): void;
}

/** Decides which token the page sends: the one that this tab remembers, or one that the user enters. */
export class Admission {
  constructor(
    private readonly store: TokenStore,
    private readonly events: AdmissionEvents,
  ) {}

  /** Returns the token for the first connection; empty if there is none. */
  begin(): string {
    this.events.tokenHeld(this.store.token !== "");
    return this.store.token;
  }

  /** Empty if there is none. */
  get token(): string {
    return this.store.token;
  }

  linkChanged({ state, reason = "" }: Pick<LinkChange, "state" | "reason">): void {
    // The connection failed for a reason other than the token: the page retries with the token that it has.
    if (state === "waiting") this.events.tokenSettled();
    if (state !== "locked") return;
    const error = this.store.token ? reason : "";
    this.saveToken("");
    this.events.tokenRequired(error);
  }

  welcomed(): void {
    this.events.tokenSettled();
  }

  /** Takes the token that the user entered, without surrounding white space. Returns false if nothing is left. */
  submit(text: string): boolean {
    const token = text.trim();
    if (!token) return false;
    this.saveToken(token);
    this.events.reconnect(token);
    return true;
  }

  forget(): void {
    this.saveToken("");
    this.events.reconnect("");
  }

  private saveToken(token: string): void {
    this.store.save(token);
    this.events.tokenHeld(token !== "");
  }
}

/**
 * Returns the address without its token, which would otherwise stay in browser histories and server logs. Undefined if
 * the address has no token.
 */
export function withoutToken(href: string): string | undefined {
  const address = new URL(href);
  const names = [...address.searchParams.keys()].filter((name) => name.toLowerCase() === "token");
  if (names.length === 0) return undefined;
  for (const name of names) address.searchParams.delete(name);
  return address.href;
}
