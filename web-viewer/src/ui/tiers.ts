import { Tier } from "../gen/spherule/v1/frame_pb";

/** How exact positions are sent; the error is at most this part of the smallest radius, on each axis. */
export const tiers = [
  { tier: Tier.FINE, name: "Fine", error: "1/500 r" },
  { tier: Tier.NORMAL, name: "Normal", error: "1/50 r" },
  { tier: Tier.ECO, name: "Eco", error: "1/16 r" },
];

export function tierWords(tier: Tier): string {
  const known = tiers.find((one) => one.tier === tier);
  return known ? `${known.name}, ${known.error}` : "–";
}
