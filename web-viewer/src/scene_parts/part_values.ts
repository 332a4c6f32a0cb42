import type { JsonObject, JsonValue } from "@bufbuild/protobuf";
import type { Outcome } from "../connection/link";
import { sentence } from "../format";

/** The problem of an outcome, for the user; empty if the server has applied the command. */
export function problemOf(outcome: Outcome): string {
  if (outcome.case === "applied") return "";
  if (outcome.case !== "refused") return "Not sent: there is no connection, or no control.";
  const { field, reason } = outcome.value;
  // Without the command and its field for the part: "drag.density" of "addField.field.drag.density".
  const place = field.replace(/^[a-z]+[A-Z]\w*\.(field\b|emitter\b|material\b(?=\.)|pair\b|number\b)?\.?/, "");
  return place ? `${place} ${reason}.` : sentence(reason);
}

/** The numbers of an entry; undefined if it has others. */
export function numbersOf(entry: string, several: boolean): number | number[] | undefined {
  const words = entry
    .replace(/\u2212/g, "-")
    .split(/[\s,;]+/)
    .filter(Boolean);
  const numbers = words.map(Number);
  if (numbers.length !== (several ? 3 : 1) || !numbers.every(Number.isFinite)) return undefined;
  return several ? numbers : numbers[0];
}

/** Returns the part with another value at the path. */
export function withValue(part: JsonObject, [key = "", ...rest]: string[], value: JsonValue): JsonObject {
  return { ...part, [key]: rest.length > 0 ? withValue(part[key] as JsonObject, rest, value) : value };
}

/** Returns the values of a part that differ from the shown ones. Returns JSON that is no part as it is. */
export function changesOf(part: JsonValue, shown: JsonObject): JsonValue {
  if (typeof part !== "object" || part === null || Array.isArray(part)) return part;
  const differs = ([key, value]: [string, JsonValue]): boolean => JSON.stringify(value) !== JSON.stringify(shown[key]);
  return Object.fromEntries(Object.entries(part).filter(differs));
}
