import { clientName } from "../connection/protocol";
import type { Person } from "../gen/spherule/v1/control_pb";

/** The name under which this page shows another client. */
export interface DisplayName {
  session: bigint;
  name: string;
  number: string; // "#" and the session; empty if the name alone is unique
}

const longest = 40; // characters

/**
 * Makes names safe to show. Clients choose their own names, so a name may contain anything: control characters are
 * removed, and the length is limited. A name that occurs twice, or is this page's own, gets a number.
 */
export function displayNames(people: Person[]): DisplayName[] {
  const names = people.map(({ client }) => sanitize(client));
  const isUnique = (name: string): boolean =>
    name !== clientName && names.filter((other) => other === name).length === 1;
  return people.map(({ session }, i) => {
    const name = names[i] ?? "";
    return { session, name: name || "somebody", number: name && isUnique(name) ? "" : `#${session}` };
  });
}

export function nameText({ name, number }: DisplayName): string {
  return number ? `${name} ${number}` : name;
}

function sanitize(client: string): string {
  const unsafe = /[\p{Cc}\p{Bidi_Control}\p{Default_Ignorable_Code_Point}]/gu;
  const visible = client.replace(unsafe, " ").replace(/\s+/gu, " ").trim();
  const letters = [...visible];
  return letters.length > longest
    ? `${letters
        .slice(0, longest - 1)
        .join("")
        .trimEnd()}…`
    : visible;
}
