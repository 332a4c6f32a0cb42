import { effect, signal } from "@preact/signals-core";
import type { Session } from "../model/session";
import type { StatisticsLists } from "../statistics/statistics";
import type { Folder } from "./folder";
import type { LoadPart } from "./parts";

/**
 * Fills the folders for diagnostics. The lists are loaded when one of the folders is first open. `now`: for the figures
 * that belong to the dial; `rest`: for the others.
 */
export function fillStatistics(now: Folder, rest: Folder, session: Session, load: LoadPart): void {
  const lists = signal<StatisticsLists | undefined>(undefined);
  let loading = false;
  const begin = async (): Promise<void> => {
    loading = true;
    const part = await load<{ StatisticsLists: new () => StatisticsLists }>("statistics");
    loading = false;
    if (!part) return;
    const made = new part.StatisticsLists();
    now.body.append(made.quality.element);
    rest.body.append(made.rest.element);
    lists.value = made;
  };
  effect(() => {
    const { diagnostics, settings } = session;
    if (!diagnostics || !(now.open || rest.open)) return;
    if (lists.value) lists.value.show(diagnostics, settings);
    else if (!loading) void begin();
  });
}
