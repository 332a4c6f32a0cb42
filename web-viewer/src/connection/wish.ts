import { Tier } from "../gen/spherule/v1/frame_pb";
import type { View } from "./messages";

/** What the server grants; anything else gets the next one below. */
export const rates = [5, 10, 20, 30, 60];

const usual: View = { tier: Tier.NORMAL, rate: 30, fixed: false };
const key = "spherule.view";

type Store = Pick<Storage, "getItem" | "setItem">;

/** What this browser wished for last, if it may remember; `address`, as in ?tier=fine&rate=10&fixed, goes before that. */
export function wishFrom(address: URLSearchParams, store: () => Store): View {
  const kept = keptIn(store);
  return {
    tier: tierOf(address.get("tier")) ?? tierOf(kept.tier) ?? usual.tier,
    rate: rateOf(address.get("rate")) ?? rateOf(kept.rate) ?? usual.rate,
    fixed: address.has("fixed") || kept.fixed === true,
  };
}

export function keep({ tier, rate, fixed }: View, store: () => Store): void {
  try {
    store().setItem(key, JSON.stringify({ tier: tierName(tier), rate, fixed }));
  } catch {
    // A browser that forbids to keep things asks for the usual next time.
  }
}

export function tierName(tier: Tier): string {
  return (Tier[tier] ?? "unknown").toLowerCase();
}

function keptIn(store: () => Store): Record<string, unknown> {
  try {
    const kept: unknown = JSON.parse(store().getItem(key) ?? "{}");
    return typeof kept === "object" && kept !== null ? (kept as Record<string, unknown>) : {};
  } catch {
    return {};
  }
}

function tierOf(name: unknown): Tier | undefined {
  return [Tier.FINE, Tier.NORMAL, Tier.ECO].find((tier) => tierName(tier) === name);
}

function rateOf(rate: unknown): number | undefined {
  return rates.find((granted) => String(granted) === String(rate));
}
