import { effect } from "@preact/signals-core";
import type { Session } from "../model/session";
import { observed } from "../observed";
import type { StatisticsLists } from "../statistics/statistics";
import type { Folder } from "./folder";
import type { LoadPart } from "./parts";

/** The content of the folders for diagnostics. Its lists are loaded when one of the folders is first open. */
export class StatisticsFolders {
  @observed private accessor lists: StatisticsLists | undefined;
  private loading = false;

  /** `quality`: for the figures that belong to the dial; `rest`: for the others. */
  constructor(
    private readonly quality: Folder,
    private readonly rest: Folder,
    session: Session,
    private readonly load: LoadPart,
  ) {
    effect(() => {
      const { diagnostics, settings } = session;
      const isOpen = quality.open || rest.open;
      if (!diagnostics || !isOpen) return;
      if (this.lists) this.lists.show(diagnostics, settings);
      else if (!this.loading) void this.begin();
    });
  }

  private async begin(): Promise<void> {
    this.loading = true;
    const part = await this.load<{ StatisticsLists: new () => StatisticsLists }>("statistics");
    this.loading = false;
    if (!part) return;
    const lists = new part.StatisticsLists();
    this.quality.body.append(lists.quality.element);
    this.rest.body.append(lists.rest.element);
    this.lists = lists;
  }
}
