import type { Outcome } from "../connection/link";
import type { Inspected } from "../gen/spherule/v1/control_pb";
import type { Session } from "./session";

const period = 250; // ms between two questions
const oldest = 1500; // ms: an answer to an earlier question is not shown

/** Asks the server for the state of the selected sphere, and tells what is known now. */
export class Inspection {
  private id: number | undefined;
  private answer: Inspected | undefined;
  private answered = 0; // ms: time of the question of the answer
  private asked = 0; // ms
  private waiting = false;
  private seen = -1; // sequence number of the newest state when the last question was asked

  constructor(
    private readonly session: Session,
    private readonly ask: (id: number) => Promise<Outcome>,
  ) {}

  /**
   * Returns the state of a sphere as the server told it; undefined if it is not known now. Then no answer has come, the
   * page shows another time, or the answer is old. Call at every tick. `now`: ms.
   */
  update(id: number | undefined, now: number): Inspected | undefined {
    const { session } = this;
    if (id !== this.id || !session.live || session.replay || session.timeline) this.forget(id);
    if (id === undefined || !session.live || session.replay || session.timeline) return undefined;
    const sequence = session.newest?.sequence ?? -1;
    const rests = session.paused && sequence === this.seen;
    if (!this.waiting && now - this.asked >= period && !(rests && this.answer)) void this.question(id, sequence, now);
    if (!rests && now - this.answered > oldest) this.answer = undefined;
    return this.answer;
  }

  private forget(id: number | undefined): void {
    this.id = id;
    this.answer = undefined;
    this.asked = 0;
    this.seen = -1;
  }

  private async question(id: number, sequence: number, now: number): Promise<void> {
    this.waiting = true;
    this.asked = now;
    this.seen = sequence;
    const outcome = await this.ask(id);
    this.waiting = false;
    if (id !== this.id) return;
    this.answer = outcome.case === "applied" ? outcome.value.inspected : undefined;
    this.answered = now;
  }
}
