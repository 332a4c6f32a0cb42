import type GUI from "lil-gui";
import type { View } from "../connection/messages";
import { rates } from "../connection/wish";
import type { Session } from "../scene/session";
import { h, setText } from "./dom";
import { reductionWords, streamRows } from "./stream_words";
import { fill } from "./table";
import { tag } from "./tag";
import { tiers } from "./tiers";

const tierNames = Object.fromEntries(tiers.map(({ tier, name, error }) => [`${name}, ${error}`, tier]));
const slowNames = { Automatic: false, Fixed: true };

const period = 1000; // ms between updates of the figures

/** What the person wants to be sent, and what is. */
export class StreamFolder {
  private readonly table = h("table", { class: "statistics", hidden: true });
  private readonly note = h("p", { class: "note", "data-testid": "stream-note", hidden: true });
  private lastFigures = 0;

  constructor(
    folder: GUI,
    private readonly wish: View,
    wished: (wish: View) => void,
  ) {
    const changed = (): void => wished({ ...wish });
    tag("tier", folder.add(wish, "tier", tierNames).name("Error, at most")).onFinishChange(changed).domElement.title =
      "How far positions may be off, on each axis; r is the smallest radius";
    tag("rate", folder.add(wish, "rate", rates).name("Frames a second")).onFinishChange(changed);
    tag("fixed", folder.add(wish, "fixed", slowNames).name("When slow")).onFinishChange(changed).domElement.title =
      "Automatic: less is sent while this page or its connection does not keep up. Fixed: frames are left out instead";
    folder.$children.append(this.note, this.table);
  }

  /** `now`: ms, as sharedNow() says. */
  update(session: Session, now: number): void {
    setText(this.note, reductionWords(session.stream));
    this.note.hidden = this.note.textContent === "";
    if (now - this.lastFigures < period) return;
    this.lastFigures = now;
    fill(this.table, "stream", streamRows(this.wish, session.stream, session.traffic.rates(now), session.lateness.newest, session.lost));
  }
}
