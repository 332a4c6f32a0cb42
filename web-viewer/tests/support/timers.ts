// Fake timers. The fake timers of Node 18's test runner lose some timers when others are cleared.
import FakeTimers from "@sinonjs/fake-timers";

let clock: FakeTimers.InstalledClock | undefined;

export const timers = {
  enable(): void {
    clock = FakeTimers.install({ toFake: ["setTimeout", "clearTimeout"] });
  },
  /** Advances the clock (ms). */
  tick(ms: number): void {
    clock?.tick(ms);
  },
  reset(): void {
    clock?.uninstall();
    clock = undefined;
  },
};
