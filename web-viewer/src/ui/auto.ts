import type { MessageInitShape } from "@bufbuild/protobuf";
import type { Auto, AutoSchema } from "../gen/spherule/v1/scene_pb";

export type GoalName = "off" | "time" | "overlap";

/** What substeps can be moved for, in the units in which a person gives it. */
export const goals: Record<GoalName, { name: string; unit: string; first: number }> = {
  off: { name: "Off", unit: "", first: 0 },
  time: { name: "Holds a step time", unit: "At most, ms", first: 16 },
  overlap: { name: "Holds an overlap", unit: "Mean, at most, %", first: 0.5 },
};

export const goalNames = Object.fromEntries(Object.entries(goals).map(([key, { name }]) => [name, key]));

export function goalFrom(name: GoalName, goal: number): MessageInitShape<typeof AutoSchema> {
  switch (name) {
    case "off":
      return {};
    case "time":
      return { goal: { case: "budgetMs", value: goal } };
    case "overlap":
      return { goal: { case: "overlap", value: goal / 100 } };
  }
}

export function heldBy(auto: Auto | undefined): { auto: GoalName; goal: number } {
  switch (auto?.goal.case) {
    case "budgetMs":
      return { auto: "time", goal: auto.goal.value };
    case "overlap":
      return { auto: "overlap", goal: Number((100 * auto.goal.value).toPrecision(6)) };
    default:
      return { auto: "off", goal: 0 };
  }
}
