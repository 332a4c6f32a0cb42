import { Tier } from "../gen/spherule/v1/frame_pb";
import type { ViewRequest } from "./messages";

/** The frame rates (1/s) that the server grants; it rounds other rates down to one of these. */
export const frameRates = [5, 10, 20, 30, 60];

const defaults: ViewRequest = { tier: Tier.NORMAL, rate: 30, fixed: false };
const key = "spherule.view";

type Store = Pick<Storage, "getItem" | "setItem">;

/**
 * Loads the request that this browser saved last. Parameters of the address, as in ?tier=fine&rate=10&fixed, override
 * it.
 */
export function loadViewRequest(address: URLSearchParams, store: () => Store): ViewRequest {
  const saved = savedIn(store);
  return {
    tier: tierOf(address.get("tier")) ?? tierOf(saved.tier) ?? defaults.tier,
    rate: rateOf(address.get("rate")) ?? rateOf(saved.rate) ?? defaults.rate,
    fixed: address.has("fixed") || saved.fixed === true,
  };
}

export function saveViewRequest({ tier, rate, fixed }: ViewRequest, store: () => Store): void {
  try {
    store().setItem(key, JSON.stringify({ tier: tierName(tier), rate, fixed }));
  } catch {
    // The browser forbids storage: the next page starts with the defaults.
  }
}

function tierName(tier: Tier): string {
  return Tier[tier].toLowerCase();
}

function savedIn(store: () => Store): Record<string, unknown> {
  try {
    const saved: unknown = JSON.parse(store().getItem(key) ?? "{}");
    return typeof saved === "object" && saved !== null ? (saved as Record<string, unknown>) : {};
  } catch {
    return {};
  }
}

function tierOf(name: unknown): Tier | undefined {
  return [Tier.FINE, Tier.NORMAL, Tier.ECO].find((tier) => tierName(tier) === name);
}

function rateOf(rate: unknown): number | undefined {
  return frameRates.find((granted) => String(granted) === String(rate));
}
