import { Role } from "../gen/spherule/v1/control_pb";
import type { Control } from "../gen/spherule/v1/control_pb";
import { displayNames, nameText } from "./names";
import type { DisplayName } from "./names";

/** Whether this page may send commands. */
export type ControlState =
  | { kind: "unrestricted" } // every client may
  | { kind: "watching" } // this page is a viewer, and may not
  | { kind: "free" } // no client has control; the next command takes it
  | { kind: "mine"; asking: DisplayName[] } // this page has control; `asking`: longest wait first
  | { kind: "taken"; holder: DisplayName; asked: boolean }; // `asked`: this page has asked for control

/** The server's reports from which the control state follows. */
export interface ControlInfo {
  welcome: { role: Role; session: bigint } | undefined;
  control: Control | undefined;
}

export function controlStateOf({ welcome, control }: ControlInfo): ControlState {
  if (welcome?.role === Role.VIEWER) return { kind: "watching" };
  if (!welcome || !control) return { kind: "unrestricted" };
  const { holder, asking } = control;
  const me = welcome.session;
  if (!holder) return { kind: "free" };
  if (holder.session === me) return { kind: "mine", asking: displayNames(asking) };
  const others = displayNames([holder, ...asking.filter(({ session }) => session !== me)]);
  return { kind: "taken", holder: others[0] as DisplayName, asked: asking.some(({ session }) => session === me) };
}

/** Says why this page may not send commands; empty if it may. */
export function blockedReasonOf(state: ControlState): string {
  switch (state.kind) {
    case "watching":
      return "You can watch but not control";
    case "taken":
      return `${nameText(state.holder)} has control`;
    default:
      return "";
  }
}

/** The answer to a request for control. Undefined if there is no answer yet, or if there was no request. */
export function controlAnswer(before: ControlState, now: ControlState): { granted: boolean; text: string } | undefined {
  if (before.kind !== "taken" || !before.asked) return undefined;
  if (now.kind === "mine") return { granted: true, text: "You have control" };
  const kept = now.kind === "taken" && !now.asked && now.holder.session === before.holder.session;
  return kept ? { granted: false, text: `${nameText(now.holder)} keeps control` } : undefined;
}
