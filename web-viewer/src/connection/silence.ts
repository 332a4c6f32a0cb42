const period = 500; // ms between looks
const asks = 2000; // ms of silence after which the server is asked for a word, and again each time as long
const tells = 4000; // after which the person is told
const gives = 12_000; // after which the connection is given up
const longest = 96_000;
const calm = 60_000; // without a silence that was told, after which the next one is judged as the first

export interface SilenceEvents {
  /** The server should be asked for something that it answers at once. */
  ask(): void;
  /** Nothing has come for so long (ms), although it was asked for; undefined: something has come again. */
  silent(since: number | undefined): void;
  /** The connection is of no use any more. */
  giveUp(): void;
}

/**
 * Notices that nothing comes over an open connection: a network that is gone says nothing of it for minutes. A large frame
 * on a slow line looks the same, as only whole messages are seen; so who gave up too early waits twice as long next time.
 */
export class Silence {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private last = 0; // ms: the look before
  private quiet = 0; // ms without a word
  private asked = 0; // times
  private told = false;
  private patience = gives;
  private eased = 0; // ms since a silence was told

  constructor(
    private readonly events: SilenceEvents,
    private readonly now: () => number = () => performance.now(),
  ) {}

  /** It was told that nothing comes. */
  get lasts(): boolean {
    return this.told;
  }

  /** A connection has opened. */
  begin(): void {
    this.end();
    this.last = this.now();
    this.timer = setTimeout(() => this.look(), period);
  }

  end(): void {
    clearTimeout(this.timer);
    this.quiet = this.asked = 0;
    this.told = false;
  }

  heard(): void {
    this.quiet = this.asked = 0;
    if (!this.told) return;
    this.told = false;
    this.events.silent(undefined);
  }

  /** Only time in which this thread was awake counts: what came while it slept still waits to be read. */
  private look(): void {
    const now = this.now();
    const awake = Math.min(now - this.last, 2 * period);
    this.last = now;
    this.quiet += awake;
    this.eased = this.told ? 0 : this.eased + awake;
    if (this.eased >= calm) this.patience = gives;
    if (this.quiet >= this.patience) {
      this.patience = Math.min(longest, 2 * this.patience);
      this.events.giveUp();
      return;
    }
    this.timer = setTimeout(() => this.look(), period);
    if (this.quiet >= asks * (this.asked + 1)) {
      this.asked += 1;
      this.events.ask();
    }
    if (this.quiet < tells || this.told) return;
    this.told = true;
    this.events.silent(this.quiet);
  }
}
