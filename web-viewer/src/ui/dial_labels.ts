import type { Settings } from "../gen/spherule/v1/control_pb";
import type { Dial, DialPosition, Statistics } from "../gen/spherule/v1/diagnostics_pb";
import { Model } from "../gen/spherule/v1/scene_pb";
import { count, figure } from "../format";
import type { Figure } from "./figures";

/** The contact models. */
export const models = [
  { model: Model.FAST, name: "Fast", description: "impulses, few substeps; for dilute scenes; deep piles sink" },
  { model: Model.BALANCED, name: "Balanced", description: "the default; piles come to rest" },
  { model: Model.ACCURATE, name: "Accurate", description: "soft spheres with contact forces; many substeps, slow" },
];

export function modelName(model: Model): string {
  return models.find((candidate) => candidate.model === model)?.name ?? "Unknown";
}

interface Curve {
  name: string;
  about: string;
  percent: boolean;
  within: boolean; // the error is the largest of several
}

/** The known error curves, most important first. */
const curves: Record<string, Curve> = {
  "bed overlap": {
    name: "Overlap in piles",
    about: "Mean overlap over radius, in a pile of a few hundred spheres at rest; it is larger in deeper piles",
    percent: true,
    within: false,
  },
  "bounce apex": {
    name: "Bounce height",
    about: "Largest error of the first five bounces",
    percent: true,
    within: true,
  },
  restitution: {
    name: "Restitution",
    about: "Largest error in impacts of two spheres",
    percent: false,
    within: true,
  },
  "slip to roll": {
    name: "Slip to roll",
    about: "Error of the time until a sliding sphere rolls",
    percent: true,
    within: true,
  },
};

function unknownCurve(name: string): Curve {
  return { name, about: "An error that the server measures", percent: true, within: true };
}

/** The index of the model's position with the nearest number of substeps; -1 if the model has no position. */
export function nearest(dial: Dial, model: Model, substeps: number): number {
  const far = (position: DialPosition): number => Math.abs(Math.log(position.substeps / Math.max(1, substeps)));
  return dial.positions.reduce((best, position, i) => {
    const known = dial.positions[best];
    return position.model === model && (!known || far(position) < far(known)) ? i : best;
  }, -1);
}

/** The measured errors of a position, most important first. */
export function errorFigures(position: DialPosition): Figure[] {
  const known = Object.keys(curves);
  const rank = (curve: string): number => (known.includes(curve) ? known.indexOf(curve) : known.length);
  return [...position.errors]
    .sort((a, b) => rank(a.curve) - rank(b.curve))
    .map(({ curve, error }) => {
      const { name, about, percent, within } = curves[curve] ?? unknownCurve(curve);
      return { id: curve.replaceAll(" ", "-"), name, about, value: errorText(error, percent, within) };
    });
}

/** Errors below 1e-5 are rounding errors, and are shown as a bound. */
function errorText(error: number, percent: boolean, within: boolean): string {
  const least = 1e-5;
  const unit = percent ? " %" : "";
  const text = `${twoDigits(percent ? 100 * error : error)}${unit}`;
  if (error < least) return `under ${percent ? "0.001 %" : "0.00001"}`;
  return within ? `within ${text}` : text;
}

/** The cost of a position with this number of substeps, and the speed that the server then reaches. */
export function costFigures(
  position: DialPosition,
  substeps: number,
  calibrated: boolean,
  { step, speed }: Pick<Settings, "step" | "speed">,
): Figure[] {
  const ms = (position.stepMs * substeps) / position.substeps;
  const reached = (1000 * step) / ms;
  const enough = 0.98; // share of the requested speed: nobody sees the difference
  const full = speed === 1 ? "holds real time" : "holds the speed";
  return [
    {
      id: "cost",
      name: "Step time",
      about: "Estimated wall time per step in the present state of the scene",
      value: `${calibrated ? "about" : "roughly"} ${twoDigits(ms)} ms`,
    },
    {
      id: "pace",
      name: "Speed",
      about: "Whether the simulation reaches the requested speed",
      value: reached >= enough * speed ? full : `runs at ${twoDigits(reached)} × real time`,
    },
  ];
}

function twoDigits(value: number): string {
  return figure(Number(value.toPrecision(2)));
}

export function substepLabel(substeps: number): string {
  return substeps === 1 ? "1 substep" : `${count(substeps)} substeps`;
}

export type Impacts = Pick<Statistics, "impacts" | "restitution" | "restitutionAsked">;

const enoughImpacts = 20n; // for a meaningful mean

/** The newest impacts, averaged with the earlier ones if they are few. */
export function mergeImpacts(before: Impacts | undefined, now: Impacts): Impacts | undefined {
  if (now.impacts === 0n || !before || now.impacts >= enoughImpacts) return now.impacts === 0n ? before : now;
  const weight = before.impacts < enoughImpacts ? before.impacts : enoughImpacts;
  const mean = (old = 0, fresh = 0): number =>
    (old * Number(weight) + fresh * Number(now.impacts)) / Number(weight + now.impacts);
  return {
    impacts: weight + now.impacts,
    restitution: mean(before.restitution, now.restitution),
    restitutionAsked: mean(before.restitutionAsked, now.restitutionAsked),
  };
}

/** The measured restitution beside the one that the materials specify, and the number of impacts. */
export function impactLabels(impacts: Impacts | undefined): { restitution: string; over: string } {
  const { restitution, restitutionAsked } = impacts ?? {};
  if (!impacts || restitution === undefined || restitutionAsked === undefined) {
    return { restitution: "–", over: "–" };
  }
  return {
    restitution: `${figure(restitution)} of ${figure(restitutionAsked)}`,
    over: count(Number(impacts.impacts)),
  };
}
