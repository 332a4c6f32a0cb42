import type { View } from "../camera/view";
import type { Mode } from "../colour/modes";
import { idRamp, radiusRamp, speedRamp } from "../colour/ramp";
import type { Ramp } from "../colour/ramp";
import type { Facts } from "../model/facts";

/** All that an image depends on, apart from the scene and its states. */
export interface DrawState extends Colouring {
  view: View;
  selected: number | undefined; // id
  dim: number; // 0..1: how stale the image is
}

/** The colour mode, with its ramp and the range of values that the ramp covers. */
export interface Colouring {
  mode: Mode;
  ramp: Ramp;
  range: [number, number];
}

/** `highSpeed`: upper end of the range of speeds (m/s). */
export function colouringFor(mode: Mode, facts: Facts | undefined, highSpeed: number): Colouring {
  switch (mode) {
    case "radius":
      return { mode, ramp: radiusRamp, range: facts?.radiusRange ?? [0, 1] };
    case "id":
      return { mode, ramp: idRamp, range: [0, Math.max(1, (facts?.count ?? 1) - 1)] };
    default:
      return { mode, ramp: speedRamp, range: [0, highSpeed] };
  }
}
