import { computed, effect, untracked } from "@preact/signals-core";
import { endsReplay } from "../connection/messages";
import type { CommandCase, ControlMessage } from "../connection/messages";
import { blockedReasonOf, controlAnswer, controlStateOf } from "../model/control_state";
import type { ControlState } from "../model/control_state";
import type { Session } from "../model/session";
import { ControlLine } from "./control_line";
import type { Toasts } from "./toasts";

/** Whether this page may send commands. */
export class Steering {
  private readonly computedState: { readonly value: ControlState };
  private readonly line: ControlLine;
  private before: ControlState = { kind: "unrestricted" }; // the last state that was reported to the user
  private withdrawn = false; // this page has withdrawn its request

  constructor(
    private readonly session: Session,
    private readonly toasts: Toasts,
    send: (message: ControlMessage) => void,
  ) {
    this.line = new ControlLine({
      request: () => send({ case: "askControl", value: {} }),
      withdraw: () => {
        this.withdrawn = true;
        send({ case: "yieldControl", value: {} });
      },
      handOver: (session) => send({ case: "yieldControl", value: { session } }),
      release: () => send({ case: "yieldControl", value: {} }),
      keep: () => send({ case: "keepControl", value: {} }),
    });
    this.computedState = computed(() => controlStateOf(session));
    effect(() => {
      const { state } = this;
      untracked(() => this.tell(state));
    });
  }

  get element(): HTMLElement {
    return this.line.element;
  }

  get state(): ControlState {
    return this.computedState.value;
  }

  /** Why nobody may send commands, as far as this page can tell: there is no connection; else empty. */
  get awayReason(): string {
    return this.session.state.blockedReason;
  }

  /** Why this page may not send commands; empty if it may. */
  get blockedReason(): string {
    return this.awayReason || blockedReasonOf(this.state);
  }

  /** Call before a command is sent. If this page may not send it, notifies the user and returns true. */
  blocked(command?: CommandCase): boolean {
    if (this.blockedReason) this.toasts.once("Not sent", this.blockedReason, "plain");
    else if (this.session.replay && command && endsReplay(command)) {
      this.toasts.once("Live again", "Commands act on the present, which the page now shows.", "plain");
    }
    return this.blockedReason !== "";
  }

  private tell(now: ControlState): void {
    const answer = controlAnswer(this.before, now);
    this.before = now;
    if (answer && (answer.granted || !this.withdrawn)) {
      this.toasts.show("Control", answer.text, answer.granted ? "good" : "plain");
    }
    this.withdrawn &&= now.kind === "taken" && now.asked;
    this.line.show(now);
  }
}
