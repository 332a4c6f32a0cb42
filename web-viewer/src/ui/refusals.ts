import { Refused_Cause as Cause } from "../gen/spherule/v1/refused_pb";
import type { Refused } from "../gen/spherule/v1/refused_pb";
import { count, figure, sentence } from "../format";
import { allowed } from "./entry";

type Refusal = Pick<Refused, "cause" | "field" | "reason" | "least" | "most">;

/** Names and units of the fields of commands that this page sends. */
const fields: Record<string, { name: string; unit: string; whole?: boolean }> = {
  "set.gravity": { name: "Gravity", unit: "m/s²" },
  "set.restitution": { name: "Restitution", unit: "" },
  "set.friction": { name: "Friction", unit: "" },
  "set.speed": { name: "Speed", unit: "× real time" },
  "set.substeps": { name: "Substeps", unit: "", whole: true },
  "set.auto.budgetMs": { name: "Step time", unit: "ms" },
  "set.auto.overlap": { name: "Mean overlap", unit: "radii" },
  "spawn.group.fill.count": { name: "Count", unit: "", whole: true },
  "spawn.group.radius.constant": { name: "Radius", unit: "m" },
  "push.impulse": { name: "Impulse", unit: "N s" },
  "step.count": { name: "Number of steps", unit: "", whole: true },
};

const texts: Partial<Record<Cause, string>> = {
  [Cause.NO_MEMORY]: "The server has too little memory for this. Use fewer spheres.",
  [Cause.BUSY]: "Another command is still under way. Wait until it is done, or cancel it.",
  [Cause.ENDED]: "A later command has replaced this one.",
  [Cause.CANCELLED]: "Cancelled. Nothing has changed.",
  [Cause.TOO_MANY_COMMANDS]: "Too many commands at once. Wait a second, and try again.",
  [Cause.NOT_ALLOWED]: "You can watch but not control. That takes another token.",
  [Cause.CONTROL_HELD]: "Somebody else has control. Request it above the buttons.",
  [Cause.NO_SUCH_SPHERE]: "This sphere does not exist any more. Select another.",
  [Cause.NO_HIT]: "There is no sphere. Aim at one.",
  [Cause.FIXED_SPHERE]: "This sphere is fixed: nothing moves it. Push another.",
  [Cause.NO_SUCH_SCENE]: "The server does not have this scene. Choose another.",
  [Cause.NOT_SUITED]: "The materials of this scene do not suit this model. Choose another model, or a weaker gravity.",
  [Cause.TOO_MANY_SUBSTEPS]: "This takes more substeps than a step may have. Choose a weaker gravity, or Fast.",
  [Cause.NON_FINITE_STATE]: "The simulation became unstable. Choose a better quality, or reset the scene.",
  [Cause.PLAYBACK]: "A recording is played here. Only its position and speed can be changed.",
  [Cause.NO_RECORDINGS]: "This server keeps no recordings.",
  [Cause.NO_CHECKPOINTS]: "This server keeps no checkpoints.",
  [Cause.RECORDING_ALREADY]: "The server is recording already.",
  [Cause.NOT_RECORDING]: "Nothing is being recorded.",
  [Cause.RECORDINGS_FULL]: "The server has no room for another recording. Delete some there.",
  [Cause.NOTHING_TO_CANCEL]: "There is nothing to cancel any more.",
  [Cause.UNFIT]: "The server does not understand this page. Reload it: it may be older.",
  [Cause.STOPPING]: "The server is stopping.",
};

/** Says in the words of the page what to do. For an unknown cause, returns the words of the server. */
export function refusalText(refused: Refusal): string {
  const { cause, reason, most } = refused;
  switch (cause) {
    case Cause.RANGE:
      return rangeText(refused);
    case Cause.NO_ROOM:
      if (!most) return "There is no free place for more spheres. Remove some, or make them smaller.";
      return `Too many spheres: at most ${count(most)} fit in the free space. Drop fewer.`;
    case Cause.TOO_LARGE:
      return `The spheres are too large. Give a radius of at most ${figure(most ?? 0)}\u00a0m.`;
    default:
      return texts[cause] ?? sentence(reason);
  }
}

function rangeText({ field, reason, least, most }: Refusal): string {
  const known = fields[field.replace(/\[\d+\]$/, "")];
  if (!known || (least === undefined && most === undefined)) return sentence(reason);
  const { name, unit, whole } = known;
  return `${name}: ${allowed({ unit, whole, least, most }).replace("Give", "give")}.`;
}
