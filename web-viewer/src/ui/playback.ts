import { sharedNow } from "../clock";
import type { Commands } from "../connection/commands";
import { Seeker } from "../connection/seeker";
import type { Session } from "../model/session";
import { placeOf } from "../model/states";
import type { Shown } from "../model/states";
import { Scrubber } from "./scrubber";
import type { ScrubberActions } from "./scrubber";

/**
 * The timeline of a recording, or of the last seconds of a simulation: shows the present position, and seeks when the
 * user moves the handle.
 */
export class Playback {
  private readonly seeker: Seeker;
  private readonly scrubber: Scrubber;
  readonly element: HTMLElement;

  /** `needsTwo`: returns true if the page shows a quantity, which needs two states. */
  constructor(
    private readonly session: Session,
    commands: Commands,
    needsTwo: () => boolean,
    actions: Pick<ScrubberActions, "present" | "save">,
  ) {
    this.seeker = new Seeker((time) => commands.seek(time), sharedNow);
    this.scrubber = new Scrubber({
      ...actions,
      present: () => {
        this.seeker.reset();
        actions.present();
      },
      seek: (time, released) => {
        const { paused, spacing } = session;
        this.seeker.seek(time, released && paused && needsTwo() ? spacing : 0);
      },
      step: () => void commands.step(1),
    });
    this.element = this.scrubber.element;
  }

  /** `now`: ms, as sharedNow() counts; `blockedReason`: why the user may not seek; empty if they may. */
  update(now: number, shown: Shown | undefined, blockedReason: string): void {
    const { session, seeker, scrubber } = this;
    const { track, replay, paused, spacing } = session;
    if (scrubber.setTrack(track)) seeker.reset();
    if (!track) return;
    const follows = track.live && !replay; // the handle follows the present
    const speed = paused ? 0 : track.live ? 1 : (session.settings?.speed ?? 1);
    const newest = follows ? undefined : (session.newest?.at ?? session.newest?.simTime);
    seeker.update({ now, newest, speed, spacing });
    const { target } = seeker;
    const usable = session.isLocal("seek") || (session.link === "open" && !blockedReason);
    scrubber.enable(usable, usable ? "" : blockedReason);
    scrubber.setReplay(replay !== undefined);
    const time = follows ? track.end : shown && placeOf(shown);
    scrubber.update(target ?? time, target ?? newest ?? time, target === undefined && paused && !follows);
  }

  /** Whether a seek is in progress. */
  get seeking(): boolean {
    return this.seeker.target !== undefined;
  }
}
