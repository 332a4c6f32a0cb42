type Store = Pick<Storage, "getItem" | "setItem" | "removeItem">;

/**
 * The token of one server, kept until this tab is closed. If the browser forbids storage, it is kept until the page is
 * reloaded.
 */
export class TokenStore {
  private readonly key: string;
  private held: string;

  /** `address`: of the server; one origin may serve several servers. */
  constructor(
    address: string,
    private readonly store: () => Store,
  ) {
    this.key = `spherule.token ${address}`;
    this.held = this.attempt((storage) => storage.getItem(this.key)) ?? "";
  }

  /** Empty if there is none. */
  get token(): string {
    return this.held;
  }

  /** An empty token removes the stored one. */
  save(token: string): void {
    this.held = token;
    this.attempt((storage) => (token ? storage.setItem(this.key, token) : storage.removeItem(this.key)));
  }

  /** Returns undefined if the browser forbids storage. */
  private attempt<T>(action: (store: Store) => T): T | undefined {
    try {
      return action(this.store());
    } catch {
      return undefined;
    }
  }
}
