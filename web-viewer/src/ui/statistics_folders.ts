import type GUI from "lil-gui";
import type { Settings } from "../gen/spherule/v1/control_pb";
import type { Diagnostics } from "../gen/spherule/v1/diagnostics_pb";
import type { StatisticsLists } from "../statistics/statistics";
import type { LoadPart } from "./parts";

/** The folders of the panel for diagnostics. Their lists are loaded when one of them is first open. */
export class StatisticsFolders {
  private lists: StatisticsLists | undefined;
  private loading = false;
  private diagnostics: Diagnostics | undefined; // the newest
  private settings: Settings | undefined; // of that moment

  /** `quality`: for the figures that belong to the dial; `rest`: for the others. */
  constructor(
    private readonly quality: GUI,
    private readonly rest: GUI,
    private readonly load: LoadPart,
  ) {
    for (const folder of [quality, rest]) folder.onOpenClose(() => this.update());
  }

  show(diagnostics: Diagnostics, settings: Settings | undefined): void {
    this.diagnostics = diagnostics;
    this.settings = settings;
    this.update();
  }

  private update(): void {
    const { diagnostics, settings, lists } = this;
    const isOpen = !this.quality._closed || !this.rest._closed;
    if (!diagnostics) return; // the panel is still being made
    if (lists) lists.show(diagnostics, settings);
    else if (isOpen && !this.loading) void this.begin();
  }

  private async begin(): Promise<void> {
    this.loading = true;
    const part = await this.load<{ StatisticsLists: new () => StatisticsLists }>("statistics");
    this.loading = false;
    if (!part) return;
    this.lists = new part.StatisticsLists();
    this.quality.$children.append(this.lists.quality.element);
    this.rest.$children.append(this.lists.rest.element);
    this.update();
  }
}
