import { count, figure } from "../format";

/** The numbers that a field accepts. */
export interface EntryRule {
  unit: string; // as in "m/s²"; empty: none
  whole?: boolean; // whole numbers only
  above?: number; // larger than this
  least?: number;
  most?: number;
}

/** Reads a number as people write it; NaN if it is none. */
export function parseEntry(text: string): number {
  const plain = text
    .trim()
    .replace(/^−/, "-")
    .replace(/e−/i, "e-")
    .replace(/(\d)[\u202f\u00a0 ](?=\d{3}(\D|$))/g, "$1");
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(plain) ? Number(plain) : NaN;
}

/** Says what is allowed; empty if the value is. */
export function entryError(value: number, rule: EntryRule): string {
  const { above, least, most, whole } = rule;
  const right =
    Number.isFinite(value) &&
    (!whole || Number.isInteger(value)) &&
    !(above !== undefined && value <= above) &&
    !(least !== undefined && value < least) &&
    !(most !== undefined && value > most);
  return right ? "" : allowed(rule);
}

/** The allowed numbers in words, as in "Give a number from 0 to 100 m". */
export function allowed({ unit, whole, above, least, most }: EntryRule): string {
  const show = (value: number): string => (whole ? count(value) : figure(value));
  const kind = `Give a ${whole ? "whole number" : "number"}`;
  const end = unit ? `\u00a0${unit}` : "";
  if (above !== undefined && most !== undefined) return `${kind} above ${show(above)} and up to ${show(most)}${end}`;
  if (above !== undefined) return `${kind} above ${show(above)}${end}`;
  if (least !== undefined && most !== undefined) return `${kind} from ${show(least)} to ${show(most)}${end}`;
  if (most !== undefined) return `${kind} of at most ${show(most)}${end}`;
  if (least !== undefined) return `${kind} of at least ${show(least)}${end}`;
  return `${kind}${unit ? ` in ${unit}` : ""}`;
}

/** The text of a value in a field: at most 6 digits, and no digits that say nothing. */
export function entryText(value: number): string {
  return String(Number(value.toPrecision(6)));
}
