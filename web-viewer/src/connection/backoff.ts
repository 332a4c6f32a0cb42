/**
 * Waits between attempts to connect (ms): doubles from `first` up to `last`; each is shortened at random by up to 25 %.
 */
export class Backoff {
  private attempts = 0;

  constructor(
    private readonly first = 250,
    private readonly last = 8000,
    private readonly random: () => number = Math.random,
  ) {}

  next(): number {
    const wait = Math.min(this.last, this.first * 2 ** this.attempts);
    this.attempts += 1;
    return wait * (1 - 0.25 * this.random());
  }

  reset(): void {
    this.attempts = 0;
  }
}
