import type { View } from "../camera/view";
import type { HalfSpace } from "../model/cut";
import type { Mode, Range } from "../model/quantities";
import type { Trace } from "../model/trace";

/** All that an image depends on, apart from the scene and its states. */
export interface DrawState {
  view: View;
  mode: Mode;
  range: Range; // of values that the mode's scale covers
  turns: boolean; // the spheres have a pattern that turns with them, if the states have orientations
  kept: HalfSpace; // what is shown of space
  selected: number | undefined; // place of the selected sphere
  trace: Trace | undefined; // the path of a sphere
  dim: number; // 0..1: how stale the image is
}
