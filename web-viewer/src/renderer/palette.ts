import type { Mode } from "../colour/modes";
import { idRamp, radiusRamp, speedRamp } from "../colour/ramp";
import type { Ramp } from "../colour/ramp";
import type { Facts } from "../scene/facts";

/** The ramp and its range that a mode colours by; `speed` is the upper end in m/s. */
export function paletteFor(mode: Mode, facts: Facts | undefined, speed: number): { mode: Mode; ramp: Ramp; range: [number, number] } {
  switch (mode) {
    case "radius":
      return { mode, ramp: radiusRamp, range: facts?.radiusRange ?? [0, 1] };
    case "id":
      return { mode, ramp: idRamp, range: [0, Math.max(1, (facts?.count ?? 1) - 1)] };
    default:
      return { mode, ramp: speedRamp, range: [0, speed] };
  }
}
