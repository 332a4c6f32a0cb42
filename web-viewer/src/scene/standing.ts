import { Role } from "../gen/spherule/v1/control_pb";
import type { Control } from "../gen/spherule/v1/control_pb";
import { namesOf, wordsFor } from "./names";
import type { Named } from "./names";

/** What this page may do with the world. */
export type Standing =
  | { kind: "everybody" } // steers, with all others
  | { kind: "watching" }
  | { kind: "free" } // nobody has the controls: who gives a command gets them
  | { kind: "mine"; asking: Named[] }
  | { kind: "taken"; holder: Named; asked: boolean };

/** What the server said: of this page, and of who has the controls. */
export interface Said {
  welcome: { role: Role; session: bigint } | undefined;
  control: Control | undefined;
}

export function standingOf({ welcome, control }: Said): Standing {
  if (welcome?.role === Role.VIEWER) return { kind: "watching" };
  if (!welcome || !control) return { kind: "everybody" };
  const { holder, asking } = control;
  const me = welcome.session;
  if (!holder) return { kind: "free" };
  if (holder.session === me) return { kind: "mine", asking: namesOf(asking) };
  const others = namesOf([holder, ...asking.filter(({ session }) => session !== me)]);
  return { kind: "taken", holder: others[0] as Named, asked: asking.some(({ session }) => session === me) };
}

/** Why commands of this page are not taken; empty: they are. */
export function hindranceOf(standing: Standing): string {
  switch (standing.kind) {
    case "watching":
      return "You may watch here, not steer";
    case "taken":
      return `${wordsFor(standing.holder)} has the controls`;
    default:
      return "";
  }
}

/** What became of asking for the controls; undefined: nothing yet, or it was not asked. */
export function answerTo(before: Standing, now: Standing): { granted: boolean; words: string } | undefined {
  if (before.kind !== "taken" || !before.asked) return undefined;
  if (now.kind === "mine") return { granted: true, words: "You have the controls" };
  const kept = now.kind === "taken" && !now.asked && now.holder.session === before.holder.session;
  return kept ? { granted: false, words: `${wordsFor(now.holder)} keeps the controls` } : undefined;
}
