import type GUI from "lil-gui";
import type { ViewRequest } from "../connection/messages";
import { frameRates } from "../connection/view_request";
import type { Session } from "../model/session";
import { tag } from "./controllers";
import { h, setText } from "./dom";
import { Figures } from "./figures";
import { reductionLabel, streamFigures, tierLabel, tiers } from "./stream_labels";

const tierNames = Object.fromEntries(tiers.map(({ tier }) => [tierLabel(tier), tier]));
const fixedNames = { Automatic: false, Fixed: true };

const period = 1000; // ms between updates of the figures

/** The folder of the panel for the stream: the user's choice, and the stream that the server sends. */
export class StreamFolder {
  private readonly figures = new Figures("stream");
  private readonly note = h("p", { class: "note", "data-testid": "stream-note", hidden: true });
  private lastUpdate = 0; // ms

  constructor(
    folder: GUI,
    private readonly view: ViewRequest,
    requested: (view: ViewRequest) => void,
  ) {
    const changed = (): void => requested({ ...view });
    const tier = tag("tier", folder.add(view, "tier", tierNames).name("Error, max"));
    tier.onFinishChange(changed).domElement.title =
      "Largest error of a position on each axis; r is the smallest radius";
    tag("rate", folder.add(view, "rate", frameRates).name("Frame rate, 1/s")).onFinishChange(changed);
    const fixed = tag("fixed", folder.add(view, "fixed", fixedNames).name("If too slow"));
    fixed.onFinishChange(changed).domElement.title =
      "If this page or its connection is too slow: Automatic lowers precision and frame rate, Fixed skips frames";
    folder.$children.append(this.note, this.figures.element);
  }

  /** `now`: ms, as sharedNow() counts. */
  update(session: Session, now: number): void {
    setText(this.note, reductionLabel(session.stream));
    this.note.hidden = this.note.textContent === "";
    if (now - this.lastUpdate < period) return;
    this.lastUpdate = now;
    const { stream, traffic, delay, lost } = session;
    this.figures.show(streamFigures(this.view, stream, traffic.rates(now), delay.newest, lost));
  }
}
