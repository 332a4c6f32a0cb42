import type { MessageInitShape } from "@bufbuild/protobuf";
import type { Auto, AutoSchema } from "../gen/spherule/v1/scene_pb";
import type { EntryRule } from "./entry";

export type GoalName = "off" | "time" | "overlap";

interface Goal {
  name: string;
  label: string;
  first: number; // the initial value, in the unit shown
  rule: EntryRule;
}

/** The goals for which the server can adjust the substeps. */
export const goals: Record<GoalName, Goal> = {
  off: { name: "Off", label: "", first: 0, rule: { unit: "" } },
  time: {
    name: "Hold step time",
    label: "Step time, max, ms",
    first: 16,
    rule: { unit: "ms", above: 0, most: 60_000 },
  },
  overlap: {
    name: "Hold overlap",
    label: "Mean overlap, max, %",
    first: 0.5,
    rule: { unit: "%", least: 0.0001, most: 50 },
  },
};

export const goalNames: Record<string, GoalName> = Object.fromEntries(
  Object.entries(goals).map(([key, { name }]) => [name, key as GoalName]),
);

/** Converts a goal in the unit shown to a message. */
export function toAuto(name: GoalName, goal: number): MessageInitShape<typeof AutoSchema> {
  switch (name) {
    case "off":
      return {};
    case "time":
      return { goal: { case: "budgetMs", value: goal } };
    case "overlap":
      return { goal: { case: "overlap", value: goal / 100 } };
  }
}

export function fromAuto(auto: Auto | undefined): { auto: GoalName; goal: number } {
  switch (auto?.goal.case) {
    case "budgetMs":
      return { auto: "time", goal: auto.goal.value };
    case "overlap":
      return { auto: "overlap", goal: Number((100 * auto.goal.value).toPrecision(6)) };
    default:
      return { auto: "off", goal: 0 };
  }
}
