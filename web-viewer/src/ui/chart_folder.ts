import type { Charts } from "../charts/charts";
import type { Samples } from "../model/samples";
import { h } from "./dom";
import { Folder } from "./folder";
import type { LoadPart } from "./parts";

/** The folder of the panel for charts. It loads them when it is first open, and does nothing while it is closed. */
export class ChartFolder {
  readonly folder = new Folder("Charts", { folded: true });
  private readonly host = h("div", { "data-testid": "charts" });
  private charts: Charts | undefined;
  private loading = false;

  constructor(private readonly load: LoadPart) {
    this.folder.body.append(this.host);
    this.folder.element.addEventListener("toggle", () => (this.loading = false)); // tries again after a failure
  }

  /** Call several times a second. */
  update(samples: Samples): void {
    if (!this.folder.open || document.hidden) return;
    if (this.charts) this.charts.update(samples);
    else if (!this.loading) void this.begin();
  }

  private async begin(): Promise<void> {
    this.loading = true;
    const part = await this.load<{ Charts: new (host: HTMLElement) => Charts }>("charts");
    if (part) this.charts = new part.Charts(this.host);
  }
}
