import { figure, percent, withPrefix } from "../format";
import type { Statistics } from "../gen/spherule/v1/diagnostics_pb";
import type { Sample } from "../model/samples";

export interface Series {
  name: string;
  value(sample: Sample): number; // NaN: unknown
}

export interface ChartKind {
  name: string;
  /** The series; they may depend on the newest sample. */
  series(newest: Sample | undefined): Series[];
  /** A value with its unit. */
  text(value: number): string;
}

const joules = (value: number): string => withPrefix(value, "J");
const axes = ["x", "y", "z"];

function energy(name: string, value: (statistics: Statistics) => number): Series {
  return { name, value: ({ statistics }) => value(statistics) };
}

function parts(vector: (statistics: Statistics) => readonly number[]): () => Series[] {
  return () => axes.map((name, axis) => ({ name, value: ({ statistics }) => vector(statistics)[axis] ?? NaN }));
}

/** The force on each surface, in scenes with contact sums. */
function forces(newest: Sample | undefined): Series[] {
  return (newest?.statistics.surfaceForces ?? []).map(({ surface }) => ({
    name: surface,
    value: ({ statistics }) => {
      const on = statistics.surfaceForces.find((one) => one.surface === surface);
      return on ? Math.hypot(...on.force) : NaN;
    },
  }));
}

export const chartKinds: readonly ChartKind[] = [
  {
    name: "Energies",
    series: () => [
      energy("kinetic", (s) => s.kineticEnergy),
      energy("rotational", (s) => s.rotationalEnergy),
      energy("potential", (s) => s.potentialEnergy),
      energy("elastic", (s) => s.elasticEnergy),
      energy("total", (s) => s.kineticEnergy + s.rotationalEnergy + s.potentialEnergy + s.elasticEnergy),
    ],
    text: joules,
  },
  { name: "Momentum", series: parts((s) => s.momentum), text: (value) => withPrefix(value, "N s") },
  { name: "Angular momentum", series: parts((s) => s.angularMomentum), text: (value) => withPrefix(value, "N m s") },
  {
    name: "Overlap",
    series: () => [
      { name: "mean", value: ({ statistics }) => statistics.overlapMean },
      { name: "largest", value: ({ statistics }) => statistics.overlapMax },
    ],
    text: percent,
  },
  { name: "Forces on walls", series: forces, text: (value) => withPrefix(value, "N") },
  {
    name: "Real-time factor",
    series: () => [{ name: "factor", value: ({ realTimeFactor }) => realTimeFactor }],
    text: (value) => `${figure(value)} ×`,
  },
  {
    name: "Frame delay",
    series: () => [{ name: "delay", value: ({ delay }) => delay }],
    text: (value) => `${figure(value)} ms`,
  },
];
