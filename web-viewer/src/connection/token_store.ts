type Store = Pick<Storage, "getItem" | "setItem" | "removeItem">;

/**
 * The token of one server, kept as long as this tab is. Where the browser forbids to keep things, it is known until the page is
 * loaded again.
 */
export class TokenStore {
  private readonly key: string;
  private held: string;

  /** `address`: of the server; others may be served from the same origin. */
  constructor(
    address: string,
    private readonly store: () => Store,
  ) {
    this.key = `spherule.token ${address}`;
    this.held = this.trying((kept) => kept.getItem(this.key)) ?? "";
  }

  /** Empty: there is none. */
  get token(): string {
    return this.held;
  }

  /** Empty: there shall be none. */
  keep(token: string): void {
    this.held = token;
    this.trying((kept) => (token ? kept.setItem(this.key, token) : kept.removeItem(this.key)));
  }

  private trying<T>(action: (store: Store) => T): T | undefined {
    try {
      return action(this.store());
    } catch {
      return undefined;
    }
  }
}
