import type { Commands } from "../connection/commands";
import { Seeker } from "../connection/seeker";
import { sharedNow } from "../clock";
import type { Session } from "../scene/session";
import { timeOf } from "../scene/states";
import type { Shown } from "../scene/states";
import { Scrubber } from "./scrubber";

/** The timeline of a server that plays a recording: what the hand wishes goes out, where the recording stands is shown. */
export class Playback {
  private readonly seeker: Seeker;
  private readonly scrubber: Scrubber;
  readonly element: HTMLElement;

  /** `speeds`: whether the picture needs to know how fast things move. */
  constructor(
    private readonly session: Session,
    commands: Commands,
    speeds: () => boolean,
  ) {
    this.seeker = new Seeker((time) => commands.seek(time), sharedNow);
    this.scrubber = new Scrubber(
      (time, last) => this.seeker.want(time, last && session.paused && speeds() ? session.spacing : 0),
      () => void commands.step(1),
    );
    this.element = this.scrubber.element;
  }

  /** `now`: ms, as sharedNow() says; `why`: it is out of use; empty: it is not. */
  update(now: number, shown: Shown | undefined, why: string): void {
    const { session, seeker, scrubber } = this;
    if (scrubber.offer(session.timeline)) seeker.forget();
    if (!session.timeline) return;
    const speed = session.paused ? 0 : (session.settings?.speed ?? 1);
    seeker.heed({ now, newest: session.states.newest?.simTime, speed, spacing: session.spacing });
    const { wanted } = seeker;
    scrubber.enable(session.link === "open" && !why, why);
    scrubber.update(wanted ?? (shown && timeOf(shown)), wanted ?? session.states.newest?.simTime, wanted === undefined && session.paused);
  }

  /** s; where the handle stands. */
  get time(): number {
    return this.scrubber.time;
  }

  /** Whether a moment that was wished for is still on its way. */
  get seeking(): boolean {
    return this.seeker.wanted !== undefined;
  }
}
