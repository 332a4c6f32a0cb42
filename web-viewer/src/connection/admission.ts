import type { LinkChange } from "./messages";
import type { TokenStore } from "./token_store";

export interface AdmissionEvents {
  /** The server wants a token. `wrong`: what it says of the one that it was given; empty: it was given none. */
  ask(wrong: string): void;
  /** Nothing is asked any more. */
  done(): void;
  /** Connect anew with this token, or, where it is empty, without. */
  identify(token: string): void;
  /** Whether this tab remembers a token. */
  held(held: boolean): void;
}

/** How the page is let in: with the token that this tab remembers, or one that the person is asked for. */
export class Admission {
  constructor(
    private readonly store: TokenStore,
    private readonly events: AdmissionEvents,
  ) {}

  /** Of the connection that is about to be made. */
  begin(): string {
    this.events.held(this.store.token !== "");
    return this.store.token;
  }

  changed({ state, reason = "" }: Pick<LinkChange, "state" | "reason">): void {
    // Anything but the token may be the matter: the page goes on trying, with the one it has.
    if (state === "waiting") this.events.done();
    if (state !== "locked") return;
    const wrong = this.store.token ? reason : "";
    this.hold("");
    this.events.ask(wrong);
  }

  welcomed(): void {
    this.events.done();
  }

  /** The person has given a token: what was copied with space around it is meant without. Returns whether there was any. */
  submit(text: string): boolean {
    const token = text.trim();
    if (!token) return false;
    this.hold(token);
    this.events.identify(token);
    return true;
  }

  forget(): void {
    this.hold("");
    this.events.identify("");
  }

  private hold(token: string): void {
    this.store.keep(token);
    this.events.held(token !== "");
  }
}
