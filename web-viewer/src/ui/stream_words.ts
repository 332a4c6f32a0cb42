import type { Stream } from "../gen/spherule/v1/control_pb";
import type { View } from "../connection/messages";
import type { Rates } from "../scene/traffic";
import { bitsPerSecond, count, figure } from "./format";
import type { Row } from "./table";
import { tierWords } from "./tiers";

const onItsWay = "How much longer the newest frame was on its way than the quickest one of the last minutes";

/** What is sent and what that takes, as rows of a table. */
export function streamRows(wish: View, sent: Stream | undefined, rates: Rates, late: number | undefined, lost: number): Row[] {
  const live = rates.frames > 0;
  const reduced = reductionWords(sent);
  const coarser = sent && sent.tier > wish.tier ? reduced : "";
  const fewer = sent && sent.rate < wish.rate ? reduced : "";
  return [
    ["tier", "Error as sent", sent ? tierWords(sent.tier) : "–", coarser],
    ["rate", "Frames as sent", sent ? `${sent.rate} /s` : "–", fewer],
    ["bandwidth", "Bandwidth", live ? bitsPerSecond(rates.bytes) : "–"],
    ["bytes", "A sphere and frame", live ? `${figure(rates.bytesPerSphere)} B` : "–"],
    ["decode", "Decoding", live ? `${figure(rates.decodeMs)} ms` : "–"],
    ["late", "Late by", live && late !== undefined ? `${late.toFixed(0)} ms` : "–", undefined, onItsWay],
    ["lost", "Frames lost", count(lost), undefined, "Frames that could not be decoded since the page was loaded"],
  ];
}

/** Why less is sent than was wanted. */
export function reductionWords(sent: Stream | undefined): string {
  return sent?.reduced ? `Less is sent than wanted. Last change: ${sent.reason}.` : "";
}
