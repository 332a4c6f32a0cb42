// Timers that go by at the test's word. Those of Node 18's own test runner lose some when others are cleared.
import FakeTimers from "@sinonjs/fake-timers";

let clock: FakeTimers.InstalledClock | undefined;

export const timers = {
  enable(): void {
    clock = FakeTimers.install({ toFake: ["setTimeout", "clearTimeout"] });
  },
  /** So many ms go by. */
  tick(ms: number): void {
    clock?.tick(ms);
  },
  reset(): void {
    clock?.uninstall();
    clock = undefined;
  },
};
