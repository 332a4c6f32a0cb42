import { sharedNow } from "./clock";

const marked = new Set<string>();

/**
 * Sets the performance mark `spherule:NAME`, once per page. In order: `connecting`, `open`, `scene`, `arrived` (the
 * first state is at the worker), `decoded` (it is at the page), `drawn` (its image has been handed to the browser).
 * `at`: ms, as sharedNow() counts.
 */
export function markFirst(name: string, at = sharedNow()): void {
  if (marked.has(name)) return;
  marked.add(name);
  performance.mark(`spherule:${name}`, { startTime: Math.max(0, at - performance.timeOrigin) });
}
