const period = 500; // ms between checks
const probeAfter = 2000; // ms of silence after which the server is probed, and between two probes
const reportAfter = 4000; // ms of silence after which the silence is reported
const shortestTimeout = 12_000; // ms of silence after which the connection is given up
const longestTimeout = 96_000;
const calm = 60_000; // ms without a reported silence after which the timeout is the shortest one again

export interface WatchdogEvents {
  /** Ask the server for something that it answers at once. */
  probe(): void;
  /** Reports the duration of a silence (ms) that outlasts the probes; undefined once a message has arrived. */
  silent(duration: number | undefined): void;
  /** Close the connection. */
  giveUp(): void;
}

/**
 * Detects that nothing arrives over an open connection: a lost network can stay unnoticed for minutes. A large frame on
 * a slow line looks the same, because only whole messages are seen. The timeout therefore doubles after each connection
 * that was given up.
 */
export class Watchdog {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private lastCheck = 0; // ms
  private quiet = 0; // ms since the last message
  private probes = 0; // since the last message
  private reported = false;
  private timeout = shortestTimeout;
  private calmTime = 0; // ms since the last reported silence

  constructor(
    private readonly events: WatchdogEvents,
    private readonly now: () => number = () => performance.now(),
  ) {}

  /** Whether a silence has been reported and still lasts. */
  get silent(): boolean {
    return this.reported;
  }

  /** Call when a connection has opened. */
  start(): void {
    this.stop();
    this.lastCheck = this.now();
    this.timer = setTimeout(() => this.check(), period);
  }

  stop(): void {
    clearTimeout(this.timer);
    this.quiet = this.probes = 0;
    this.reported = false;
  }

  /** Call when a message arrives. */
  feed(): void {
    this.quiet = this.probes = 0;
    if (!this.reported) return;
    this.reported = false;
    this.events.silent(undefined);
  }

  /** Counts only time in which this thread ran: messages that arrived while it slept have not been read yet. */
  private check(): void {
    const now = this.now();
    const awake = Math.min(now - this.lastCheck, 2 * period);
    this.lastCheck = now;
    this.quiet += awake;
    this.calmTime = this.reported ? 0 : this.calmTime + awake;
    if (this.calmTime >= calm) this.timeout = shortestTimeout;
    if (this.quiet >= this.timeout) {
      this.timeout = Math.min(longestTimeout, 2 * this.timeout);
      this.events.giveUp();
      return;
    }
    this.timer = setTimeout(() => this.check(), period);
    if (this.quiet >= probeAfter * (this.probes + 1)) {
      this.probes += 1;
      this.events.probe();
    }
    if (this.quiet < reportAfter || this.reported) return;
    this.reported = true;
    this.events.silent(this.quiet);
  }
}
