import { endsReplay } from "../connection/messages";
import type { CommandCase, ControlMessage } from "../connection/messages";
import { blockedReasonOf, controlAnswer, controlStateOf } from "../model/control_state";
import type { ControlInfo, ControlState } from "../model/control_state";
import { pageStateOf } from "../model/page_state";
import type { Session } from "../model/session";
import { ControlLine } from "./control_line";
import type { Toasts } from "./toasts";

/** Follows whether this page may send commands, and updates the page accordingly. */
export class Steering {
  state: ControlState = { kind: "unrestricted" };
  blockedReason = ""; // why this page may not send commands; empty if it may
  private awayReason = ""; // why nobody may, as far as this page can tell: there is no connection
  private readonly line: ControlLine;
  private info: ControlInfo = { welcome: undefined, control: undefined }; // from which the state was derived
  private withdrawn = false; // this page has withdrawn its request

  /**
   * `restrict`: disables all that sends commands, with the given reason; an empty reason enables it. `awayReason`: the
   * same if no server can be asked for anything.
   */
  constructor(
    private readonly session: Session,
    private readonly toasts: Toasts,
    send: (message: ControlMessage) => void,
    private readonly restrict: (blockedReason: string, awayReason: string) => void,
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
  }

  get element(): HTMLElement {
    return this.line.element;
  }

  /** Call before a command is sent. If this page may not send it, notifies the user and returns true. */
  blocked(command?: CommandCase): boolean {
    this.update();
    if (this.blockedReason) this.toasts.once("Not sent", this.blockedReason, "plain");
    else if (this.session.replay && command && endsReplay(command)) {
      this.toasts.once("Live again", "Commands act on the present, which the page now shows.", "plain");
    }
    return this.blockedReason !== "";
  }

  update(): void {
    const { welcome, control } = this.session;
    if (welcome !== this.info.welcome || control !== this.info.control) this.controlChanged({ welcome, control });
    const { blockedReason: awayReason } = pageStateOf(this.session);
    const blockedReason = awayReason || blockedReasonOf(this.state);
    if (blockedReason === this.blockedReason && awayReason === this.awayReason) return;
    this.blockedReason = blockedReason;
    this.awayReason = awayReason;
    this.restrict(blockedReason, awayReason);
  }

  private controlChanged(info: ControlInfo): void {
    this.info = info;
    const before = this.state;
    const now = controlStateOf(this.info);
    this.state = now;
    const answer = controlAnswer(before, now);
    if (answer && (answer.granted || !this.withdrawn)) {
      this.toasts.show("Control", answer.text, answer.granted ? "good" : "plain");
    }
    this.withdrawn &&= now.kind === "taken" && now.asked;
    this.line.show(now);
  }
}
