import type { ViewRequest } from "../connection/messages";
import type { Stream } from "../gen/spherule/v1/control_pb";
import { Tier } from "../gen/spherule/v1/frame_pb";
import type { Rates } from "../model/traffic";
import { bitsPerSecond, count, figure } from "../format";
import type { Figure } from "./figures";

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

/** The stream that the server sends, and its cost. `delay`: ms. */
export function streamFigures(
  requested: ViewRequest,
  sent: Stream | undefined,
  rates: Rates,
  delay: number | undefined,
  lost: number,
): Figure[] {
  const live = rates.frames > 0;
  const reduced = reductionLabel(sent);
  const coarser = sent && sent.tier > requested.tier ? reduced : "";
  const fewer = sent && sent.rate < requested.rate ? reduced : "";
  return [
    {
      id: "tier",
      name: "Error, sent",
      value: sent ? tierLabel(sent.tier) : "–",
      about: "Largest error of a position in frames, on each axis. r is the smallest radius",
      warning: coarser,
    },
    {
      id: "rate",
      name: "Frame rate, sent",
      value: sent ? `${sent.rate} /s` : "–",
      about: "Frames that the server sends each second. Between them the page interpolates",
      warning: fewer,
    },
    {
      id: "bandwidth",
      name: "Bandwidth",
      value: live ? bitsPerSecond(rates.bytes) : "–",
      about: "Data of all frames, mean of the last seconds",
    },
    {
      id: "bytes",
      name: "Frame, per sphere",
      value: live ? `${figure(rates.bytesPerSphere)} B` : "–",
      about: "Size of a frame over the number of spheres",
    },
    {
      id: "decode",
      name: "Decode time",
      value: live ? `${figure(rates.decodeMs)} ms` : "–",
      about: "Time in which this page decodes a frame",
    },
    {
      id: "late",
      name: "Delay",
      value: live && delay !== undefined ? `${delay.toFixed(0)} ms` : "–",
      about: "How much longer the newest frame was in transit than the fastest frame of the last minutes",
    },
    {
      id: "lost",
      name: "Frames lost",
      value: count(lost),
      about: "Frames that could not be decoded since the page was loaded",
    },
  ];
}

/** Says why the server sends less than requested; empty if it does not. */
export function reductionLabel(sent: Stream | undefined): string {
  return sent?.reduced ? `The server sends less than requested. Last change: ${sent.reason}.` : "";
}
