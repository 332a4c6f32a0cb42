import { clientName } from "../connection/client";
import type { Person } from "../gen/spherule/v1/control_pb";

/** Somebody else, as the page calls them. */
export interface Named {
  session: bigint;
  name: string;
  number: string; // empty: the name alone tells who it is
}

const longest = 40; // characters

/**
 * Names are what other clients say of themselves: nothing in them may hide, turn the words around it, or fill the page. Who has
 * the same name as another one, or as this page, gets a number.
 */
export function namesOf(people: Person[]): Named[] {
  const names = people.map(({ client }) => cleaned(client));
  const alone = (name: string): boolean => name !== clientName && names.filter((other) => other === name).length === 1;
  return people.map(({ session }, i) => {
    const name = names[i] ?? "";
    return { session, name: name || "somebody", number: name && alone(name) ? "" : `#${session}` };
  });
}

export function wordsFor({ name, number }: Named): string {
  return number ? `${name} ${number}` : name;
}

function cleaned(client: string): string {
  const visible = client.replace(/[\p{Cc}\p{Bidi_Control}\p{Default_Ignorable_Code_Point}]/gu, " ").replace(/\s+/gu, " ").trim();
  const letters = [...visible];
  return letters.length > longest ? `${letters.slice(0, longest - 1).join("").trimEnd()}…` : visible;
}
