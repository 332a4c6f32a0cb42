import { sharedNow } from "../clock";
import type { Commands } from "../connection/commands";
import { Seeker } from "../connection/seeker";
import type { Session } from "../model/session";
import { timeOf } from "../model/states";
import type { Shown } from "../model/states";
import { Scrubber } from "./scrubber";

/**
 * The timeline of a server that plays a recording: shows the present position, and seeks when the user moves the
 * handle.
 */
export class Playback {
  private readonly seeker: Seeker;
  private readonly scrubber: Scrubber;
  readonly element: HTMLElement;

  /** `needsSpeeds`: returns true if the page shows speeds, which needs two states. */
  constructor(
    private readonly session: Session,
    commands: Commands,
    needsSpeeds: () => boolean,
  ) {
    this.seeker = new Seeker((time) => commands.seek(time), sharedNow);
    this.scrubber = new Scrubber(
      (time, released) => {
        const lead = released && session.paused && needsSpeeds();
        this.seeker.seek(time, lead ? session.spacing : 0);
      },
      () => void commands.step(1),
    );
    this.element = this.scrubber.element;
  }

  /** `now`: ms, as sharedNow() counts; `blockedReason`: why the user may not seek; empty if they may. */
  update(now: number, shown: Shown | undefined, blockedReason: string): void {
    const { session, seeker, scrubber } = this;
    if (scrubber.setTimeline(session.timeline)) seeker.reset();
    if (!session.timeline) return;
    const speed = session.paused ? 0 : (session.settings?.speed ?? 1);
    const newest = session.newest?.simTime;
    seeker.update({ now, newest, speed, spacing: session.spacing });
    const { target } = seeker;
    scrubber.enable(session.link === "open" && !blockedReason, blockedReason);
    const still = target === undefined && session.paused;
    scrubber.update(target ?? (shown && timeOf(shown)), target ?? newest, still);
  }

  /** Whether a seek is in progress. */
  get seeking(): boolean {
    return this.seeker.target !== undefined;
  }
}
