import { AutoRange } from "../colour/range";
import type { Facts } from "./facts";
import { modes, quantityOf } from "./quantities";
import type { Mode, Range } from "./quantities";
import type { Shown } from "./states";

interface Automatic {
  range: AutoRange;
  value(facts: Facts, shown: Shown, place: number): number;
}

/** Ends of a scale that the user has given; undefined: automatic. */
export interface GivenRange {
  low?: number | undefined;
  high?: number | undefined;
}

/** The range of values that the scale of each mode covers. */
export class ColourRanges {
  private readonly given = new Map<Mode, GivenRange>();
  private readonly automatic = new Map<Mode, Automatic>();
  private measured = -1; // sequence number of the state whose values were last measured
  private mode: Mode | undefined; // in which that was
  private last = 0; // ms

  constructor() {
    for (const mode of modes) {
      const { scale } = quantityOf(mode);
      if (scale && "value" in scale) {
        this.automatic.set(mode, { range: new AutoRange(scale.least), value: scale.value });
      }
    }
  }

  isAutomatic(mode: Mode): boolean {
    return this.automatic.has(mode);
  }

  /** The ends that the user has given. */
  givenOf(mode: Mode): GivenRange {
    return this.given.get(mode) ?? {};
  }

  give(mode: Mode, range: GivenRange): void {
    this.given.set(mode, range);
  }

  /** The range of a mode. */
  of(mode: Mode, facts: Facts | undefined): Range {
    const automatic = this.automaticOf(mode, facts);
    const given = this.givenOf(mode);
    return [given.low ?? automatic[0], given.high ?? automatic[1]];
  }

  /** The range of a mode if the user gives none; 0 to 1 if there is no scale, or no scene yet. */
  automaticOf(mode: Mode, facts: Facts | undefined): Range {
    const { scale } = quantityOf(mode);
    if (facts && scale && "range" in scale) return scale.range(facts);
    return [0, this.automatic.get(mode)?.range.high ?? 1];
  }

  /** Adapts the automatic range of a mode to the values that are shown, four times a second. `now`: ms. */
  update(mode: Mode, facts: Facts | undefined, shown: Shown | undefined, now: number): void {
    const automatic = this.automatic.get(mode);
    if (!automatic || !facts || !shown || shown.to.sequence === this.measured) return;
    if (mode === this.mode && now - this.last < samplePeriod) return;
    this.mode = mode;
    this.last = now;
    this.measured = shown.to.sequence;
    const places = Math.min(shown.from.count, shown.to.count);
    const { range, value } = automatic;
    const high = highOf(
      (place) => value(facts, shown, place),
      places,
      (place) => facts.population.isUsed(place),
    );
    if (high !== undefined) range.update(high, now);
  }

  /** Resets the ranges for another scene, unless they are locked. */
  reset(): void {
    if (!this.locked) this.given.clear();
    for (const { range } of this.automatic.values()) range.reset();
  }

  /** Whether the automatic ranges do not change. */
  get locked(): boolean {
    for (const { range } of this.automatic.values()) if (!range.locked) return false;
    return true;
  }

  toggleLock(): void {
    const locked = !this.locked;
    for (const { range } of this.automatic.values()) range.locked = locked;
  }
}

const samplePeriod = 250; // ms
const samples = new Float64Array(2048); // reused: each state is sampled

/**
 * The 98th percentile of the values at the places in use, from at most 2048 of them, spread over all; undefined if none
 * is known. `value`: NaN if it is unknown. `places`: their number, free ones included.
 */
export function highOf(
  value: (place: number) => number,
  places: number,
  isUsed: (place: number) => boolean = () => true,
): number | undefined {
  const parts = Math.min(samples.length, places);
  let found = 0;
  for (let part = 0; part < parts; part++) {
    const end = Math.floor(((part + 1) * places) / parts);
    let place = Math.floor((part * places) / parts);
    while (place < end && !isUsed(place)) place += 1;
    const known = place < end ? value(place) : NaN;
    if (known === known) samples[found++] = known;
  }
  if (found === 0) return undefined;
  return samples.subarray(0, found).sort()[Math.floor(0.98 * (found - 1))];
}
