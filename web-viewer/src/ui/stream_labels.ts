import type { ViewRequest } from "../connection/messages";
import type { Stream } from "../gen/spherule/v1/control_pb";
import { Tier } from "../gen/spherule/v1/frame_pb";
import type { Rates } from "../model/traffic";
import { bitsPerSecond, count, figure } from "../format";
import type { Row } from "./dom";

/** The precisions of positions. `error`: the largest error on each axis, as a fraction of the smallest radius. */
export const tiers = [
  { tier: Tier.FINE, name: "Fine", error: "1/500 r" },
  { tier: Tier.NORMAL, name: "Normal", error: "1/50 r" },
  { tier: Tier.ECO, name: "Eco", error: "1/16 r" },
];

export function tierLabel(tier: Tier): string {
  const known = tiers.find((one) => one.tier === tier);
  return known ? `${known.name}, ${known.error}` : "–";
}

const delayTitle = "How much longer the newest frame was in transit than the fastest frame of the last minutes";
const lostTitle = "Frames that could not be decoded since the page was loaded";

/** The stream that the server sends, and its cost. `delay`: ms. */
export function streamRows(
  requested: ViewRequest,
  sent: Stream | undefined,
  rates: Rates,
  delay: number | undefined,
  lost: number,
): Row[] {
  const live = rates.frames > 0;
  const reduced = reductionLabel(sent);
  const coarser = sent && sent.tier > requested.tier ? reduced : "";
  const fewer = sent && sent.rate < requested.rate ? reduced : "";
  return [
    ["tier", "Error, sent", sent ? tierLabel(sent.tier) : "–", coarser],
    ["rate", "Frame rate, sent", sent ? `${sent.rate} /s` : "–", fewer],
    ["bandwidth", "Bandwidth", live ? bitsPerSecond(rates.bytes) : "–"],
    ["bytes", "Frame, per sphere", live ? `${figure(rates.bytesPerSphere)} B` : "–"],
    ["decode", "Decode time", live ? `${figure(rates.decodeMs)} ms` : "–"],
    ["late", "Delay", live && delay !== undefined ? `${delay.toFixed(0)} ms` : "–", undefined, delayTitle],
    ["lost", "Frames lost", count(lost), undefined, lostTitle],
  ];
}

/** Says why the server sends less than requested; empty if it does not. */
export function reductionLabel(sent: Stream | undefined): string {
  return sent?.reduced ? `The server sends less than requested. Last change: ${sent.reason}.` : "";
}
