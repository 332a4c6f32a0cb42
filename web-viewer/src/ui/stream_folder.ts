import type { ViewRequest } from "../connection/messages";
import { frameRates } from "../connection/view_request";
import type { Choices } from "./choices";
import type { Session } from "../model/session";
import { h, setText } from "./dom";
import { Figures } from "./figures";
import { Folder } from "./folder";
import { reductionLabel, streamFigures, tierLabel, tiers } from "./stream_labels";

const tierNames = Object.fromEntries(tiers.map(({ tier }) => [tierLabel(tier), tier]));
const rates = Object.fromEntries(frameRates.map((rate) => [String(rate), rate]));
const fixedNames = { Automatic: false, Fixed: true };

const period = 1000; // ms between updates of the figures

/** The folder of the panel for the stream: the user's choice, and the stream that the server sends. */
export class StreamFolder {
  readonly folder = new Folder("Stream", { folded: true });
  private readonly figures = new Figures("stream");
  private readonly note = h("p", { class: "note", "data-testid": "stream-note", hidden: true });
  private lastUpdate = 0; // ms

  constructor(
    private readonly choices: Choices,
    requested: (view: ViewRequest) => void,
  ) {
    const { folder } = this;
    const change = (part: Partial<ViewRequest>): void => {
      choices.view = { ...choices.view, ...part };
      requested(choices.view);
    };
    folder.choice("tier", "Error, max", {
      title: "Largest error of a position on each axis; r is the smallest radius",
      options: tierNames,
      get: () => choices.view.tier,
      set: (tier) => change({ tier }),
    });
    folder.choice("rate", "Frame rate, 1/s", {
      options: rates,
      get: () => choices.view.rate,
      set: (rate) => change({ rate }),
    });
    folder.choice("fixed", "If too slow", {
      title: "If page or connection are slow: Automatic lowers precision and frame rate, Fixed skips frames",
      options: fixedNames,
      get: () => choices.view.fixed,
      set: (fixed) => change({ fixed }),
    });
    folder.body.append(this.note, this.figures.element);
  }

  /** `now`: ms, as sharedNow() counts. */
  update(session: Session, now: number): void {
    setText(this.note, reductionLabel(session.stream));
    this.note.hidden = this.note.textContent === "";
    if (now - this.lastUpdate < period) return;
    this.lastUpdate = now;
    const { stream, traffic, delay, lost } = session;
    this.figures.show(streamFigures(this.choices.view, stream, traffic.rates(now), delay.newest, lost));
  }
}
