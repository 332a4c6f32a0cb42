import type GUI from "lil-gui";
import type { Charts } from "../charts/charts";
import type { Samples } from "../model/samples";
import { h } from "./dom";

/** The folder of the panel for charts. It loads them when it is first open, and does nothing while it is closed. */
export class ChartFolder {
  private readonly host = h("div", { "data-testid": "charts" });
  private charts: Charts | undefined;
  private loading = false;

  constructor(private readonly folder: GUI) {
    folder.$children.append(this.host);
    folder.onOpenClose(() => (this.loading = false)); // tries again after a failure
  }

  /** Call several times a second. */
  update(samples: Samples): void {
    if (this.folder._closed || document.hidden) return;
    if (this.charts) this.charts.update(samples);
    else if (!this.loading) void this.load();
  }

  private async load(): Promise<void> {
    this.loading = true;
    try {
      const { Charts } = await import("../charts/charts");
      this.host.replaceChildren();
      this.charts = new Charts(this.host);
    } catch {
      const text = "The charts could not be loaded. Close this folder and open it again.";
      this.host.replaceChildren(h("p", { class: "note" }, text));
    }
  }
}
