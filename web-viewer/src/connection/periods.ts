import type { SceneFacts } from "../gen/spherule/v1/facts_pb";
import { Axis } from "../gen/spherule/v1/scene_pb";

/** The length of each periodic axis (m); 0: not periodic. */
export type Periods = [number, number, number];

export function periodsOf({ boundsMin, boundsMax, periodic }: SceneFacts): Periods {
  const length = (axis: Axis): number => {
    const index = axis - Axis.X;
    return periodic.includes(axis) ? (boundsMax[index] ?? 0) - (boundsMin[index] ?? 0) : 0;
  };
  return [length(Axis.X), length(Axis.Y), length(Axis.Z)];
}
