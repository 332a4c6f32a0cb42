import { Event_Kind } from "../gen/spherule/v1/control_pb";
import type { Command, Event, Set } from "../gen/spherule/v1/control_pb";
import { count, figure } from "../format";
import type { Vec3 } from "../model/facts";
import { displayNames, nameText } from "../model/names";
import { modelName, substepLabel } from "./dial_labels";
import { customGravity, gravityPresetOf } from "./presets";

/** A deed of another client, as in "Ada" and "set gravity to Moon". */
export interface Announcement {
  who: string;
  what: string;
}

/** Returns undefined for an event that is not about another client. `playing`: the server plays a recording. */
export function announcementOf(event: Event, playing: boolean): Announcement | undefined {
  const { kind, by, command, spheres } = event;
  if (kind !== Event_Kind.COMMANDED || !by) return undefined;
  const [person] = displayNames([by]);
  const what = command && deedOf(command.kind, spheres, playing);
  return person && what ? { who: nameText(person), what } : undefined;
}

function deedOf(kind: Command["kind"], spheres: bigint, playing: boolean): string | undefined {
  const some = `${count(spheres)} ${spheres === 1n ? "sphere" : "spheres"}`;
  switch (kind.case) {
    case "pause":
      return playing ? "paused the playback" : "paused the simulation";
    case "resume":
      return playing ? "resumed the playback" : "resumed the simulation";
    case "reset":
      return playing ? "went to the beginning" : "reset the scene";
    case "load":
      return `loaded ${kind.value.source.case === "name" ? kind.value.source.value : "a scene"}`;
    case "spawn":
      return `added ${some}`;
    case "remove":
      return `removed ${some}`;
    case "set":
      return `set ${settingsOf(kind.value).join(", ")}`;
    case "removeGroup":
      return `removed a group with ${some}`;
    default:
      // Such as "addField" and "setPair".
      return /^(add|change|remove|set)[A-Z]/.test(kind.case ?? "") ? "changed the scene" : undefined;
  }
}

function settingsOf({ gravity, restitution, friction, speed, model, substeps, auto }: Set): string[] {
  const parts: string[] = [];
  if (gravity.length === 3) parts.push(`gravity to ${gravityText(gravity as Vec3)}`);
  if (restitution !== undefined) parts.push(`restitution to ${figure(restitution)}`);
  if (friction !== undefined) parts.push(`friction to ${figure(friction)}`);
  if (speed !== undefined) parts.push(`speed to ${figure(speed)} ×`);
  if (model !== undefined) parts.push(`quality to ${modelName(model)}`);
  if (substeps !== undefined) parts.push(`quality to ${substepLabel(substeps)}`);
  if (auto) parts.push(`automatic quality ${auto.goal.case ? "on" : "off"}`);
  return parts;
}

function gravityText(gravity: Vec3): string {
  const preset = gravityPresetOf(gravity);
  return preset === customGravity ? `${gravity.map(figure).join("  ")} m/s²` : preset;
}
