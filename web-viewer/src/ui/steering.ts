import { create } from "@bufbuild/protobuf";
import type { ControlWish } from "../connection/messages";
import { AskControlSchema, KeepControlSchema, YieldControlSchema } from "../gen/spherule/v1/control_pb";
import type { Session } from "../scene/session";
import { answerTo, hindranceOf, standingOf } from "../scene/standing";
import type { Standing } from "../scene/standing";
import { ControlLine } from "./control_line";
import type { Toasts } from "./toasts";

/** Whether the person may steer: follows what the server says of that, and says it on. */
export class Steering {
  standing: Standing = { kind: "everybody" };
  why = ""; // nothing can be commanded; empty: it can
  private readonly line: ControlLine;
  private said: Pick<Session, "welcome" | "control"> = { welcome: undefined, control: undefined }; // that it follows from
  private withdrawn = false; // no answer is waited for

  /** `say` goes to the server; `restrict`: what commands is out of use from now on, or, where `why` is empty, of use. */
  constructor(
    private readonly session: Session,
    private readonly toasts: Toasts,
    say: (wish: ControlWish) => void,
    private readonly restrict: (why: string) => void,
  ) {
    this.line = new ControlLine({
      ask: () => say({ case: "askControl", value: create(AskControlSchema) }),
      withdraw: () => {
        this.withdrawn = true;
        say({ case: "yieldControl", value: create(YieldControlSchema) });
      },
      give: (session) => say({ case: "yieldControl", value: create(YieldControlSchema, { session }) }),
      release: () => say({ case: "yieldControl", value: create(YieldControlSchema) }),
      keep: () => say({ case: "keepControl", value: create(KeepControlSchema) }),
    });
  }

  get element(): HTMLElement {
    return this.line.element;
  }

  /** Whether commands would not be taken; who tries to give one is told why. */
  hindered(): boolean {
    this.update();
    if (this.why) this.toasts.once("Not done", this.why, "plain");
    return this.why !== "";
  }

  update(): void {
    const { welcome, control } = this.session;
    if (welcome === this.said.welcome && control === this.said.control) return;
    this.said = { welcome, control };
    const before = this.standing;
    const now = standingOf(this.said);
    this.standing = now;
    this.why = hindranceOf(now);
    const answer = answerTo(before, now);
    if (answer && (answer.granted || !this.withdrawn)) this.toasts.show("Controls", answer.words, answer.granted ? "good" : "plain");
    this.withdrawn &&= now.kind === "taken" && now.asked;
    this.line.show(now);
    this.restrict(this.why);
  }
}
