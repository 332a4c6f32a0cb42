import type { Dial, DialPosition, Settings, Statistics } from "../gen/spherule/v1/control_pb";
import type { Model } from "../gen/spherule/v1/scene_pb";
import { count, figure } from "./format";

/** What a cost depends on, of the settings. */
export type Pace = Pick<Settings, "step" | "speed">;

export interface Row {
  id: string;
  name: string;
  title: string;
  value: string;
}

const curves: Record<string, { name: string; title: string; percent: boolean; within: boolean }> = {
  "bed overlap": { name: "Pile overlaps", title: "Mean overlap, over the radius, in a pile of some hundreds at rest; deeper ones overlap more", percent: true, within: false },
  "bounce apex": { name: "Bounce height", title: "Largest error of the first five", percent: true, within: true },
  restitution: { name: "Restitution", title: "Largest error when two spheres meet", percent: false, within: true },
  "slip to roll": { name: "Slip to roll", title: "Error of the time that a sliding sphere takes until it rolls", percent: true, within: true },
};

/** The position of the model with the nearest number of substeps; -1 where it has none. */
export function nearest(dial: Dial, model: Model, substeps: number): number {
  const far = (position: DialPosition): number => Math.abs(Math.log(position.substeps / Math.max(1, substeps)));
  return dial.positions.reduce((best, position, i) => {
    const known = dial.positions[best];
    return position.model === model && (!known || far(position) < far(known)) ? i : best;
  }, -1);
}

/** The measured errors of a position, in the order in which they matter most. */
export function errorRows(position: DialPosition): Row[] {
  const known = Object.keys(curves);
  const place = (curve: string): number => (known.includes(curve) ? known.indexOf(curve) : known.length);
  return [...position.errors]
    .sort((a, b) => place(a.curve) - place(b.curve))
    .map(({ curve, error }) => {
      const { name, title, percent, within } = curves[curve] ?? { name: curve, title: "", percent: true, within: true };
      return { id: curve.replaceAll(" ", "-"), name, title, value: amount(error, percent, within) };
    });
}

/** Errors below a hundred-thousandth are rounding, and their digits would say nothing. */
function amount(error: number, percent: boolean, within: boolean): string {
  const least = 1e-5;
  const unit = percent ? " %" : "";
  const shown = (value: number): string => `${figure(Number((percent ? 100 * value : value).toPrecision(2)))}${unit}`;
  if (error < least) return `under ${percent ? "0.001 %" : "0.00001"}`;
  return within ? `within ${shown(error)}` : shown(error);
}

/** What so many substeps cost near this position, and whether the world keeps its pace with it. */
export function costRows(position: DialPosition, substeps: number, calibrated: boolean, { step, speed }: Pace): Row[] {
  const ms = (position.stepMs * substeps) / position.substeps;
  const pace = (1000 * step) / ms;
  const almost = 0.98; // of the speed: nobody sees the difference
  const keeps = speed === 1 ? "holds real time" : "holds the speed";
  const two = (value: number): string => figure(Number(value.toPrecision(2)));
  return [
    { id: "cost", name: "A step here", title: "Wall time in this scene as it is now", value: `${calibrated ? "about" : "roughly"} ${two(ms)} ms` },
    { id: "pace", name: "So the world", title: "Of the speed that is asked for", value: pace >= almost * speed ? keeps : `runs at ${two(pace)} × real time` },
  ];
}

export function substepWords(substeps: number): string {
  return substeps === 1 ? "1 substep" : `${count(substeps)} substeps`;
}

export type Impacts = Pick<Statistics, "impacts" | "restitution" | "restitutionAsked">;

const enough = 20n; // impacts: a single one among many spheres says nothing

/** The newest impacts, together with those before where they are few. */
export function moreImpacts(before: Impacts | undefined, now: Impacts): Impacts | undefined {
  if (now.impacts === 0n || !before || now.impacts >= enough) return now.impacts === 0n ? before : now;
  const impacts = before.impacts < enough ? before.impacts : enough; // what is older counts for no more
  const mean = (old = 0, fresh = 0): number => (old * Number(impacts) + fresh * Number(now.impacts)) / Number(impacts + now.impacts);
  return {
    impacts: impacts + now.impacts,
    restitution: mean(before.restitution, now.restitution),
    restitutionAsked: mean(before.restitutionAsked, now.restitutionAsked),
  };
}

/** The restitution that impacts had, of the one that their materials ask for. */
export function impactWords(impacts: Impacts | undefined): { restitution: string; over: string } {
  if (impacts?.restitution === undefined || impacts.restitutionAsked === undefined) return { restitution: "–", over: "–" };
  return { restitution: `${figure(impacts.restitution)} of ${figure(impacts.restitutionAsked)}`, over: count(Number(impacts.impacts)) };
}
