import { sharedNow } from "./clock";

const marked = new Set<string>();

/**
 * Leaves a mark `spherule:NAME` in the browser's own record of times when something happens for the first time on this page.
 * `at`: ms, as sharedNow() says.
 */
export function markFirst(name: string, at = sharedNow()): void {
  if (marked.has(name)) return;
  marked.add(name);
  performance.mark(`spherule:${name}`, { startTime: Math.max(0, at - performance.timeOrigin) });
}
