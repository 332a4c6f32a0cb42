import type { Settings } from "../gen/spherule/v1/control_pb";
import type { Diagnostics, FlowCounts, Statistics } from "../gen/spherule/v1/diagnostics_pb";
import { Model } from "../gen/spherule/v1/scene_pb";
import { count, figure, length, percent, seconds, vector, withPrefix } from "../format";
import { impactLabels, mergeImpacts } from "../ui/dial_labels";
import type { Impacts } from "../ui/dial_labels";
import { Figures } from "../ui/figures";
import type { Figure } from "../ui/figures";

/** The diagnostics in two lists: the figures that belong to the dial, and the others. */
export class StatisticsLists {
  readonly quality = new Figures("statistics");
  readonly rest = new Figures("statistics");

  /** The last impacts reported: if impacts are rare, most reports have none. */
  private impacts: Impacts | undefined;
  private step = 0n;

  show(now: Diagnostics, settings: Settings | undefined): void {
    const s = now.statistics;
    if (!s) return;
    if (s.step < this.step) this.impacts = undefined; // another scene
    this.step = s.step;
    this.impacts = mergeImpacts(this.impacts, s);
    this.quality.show(qualityFigures(now, s, this.impacts, settings));
    this.rest.show([...motion(s), ...turnover(s), ...flows(s), ...sums(s), ...progress(s)]);
  }
}

function joules(energy: number): string {
  return withPrefix(energy, "J");
}

function qualityFigures(
  now: Diagnostics,
  s: Statistics,
  impacts: Impacts | undefined,
  settings: Settings | undefined,
): Figure[] {
  const measured = settings?.model !== Model.ACCURATE;
  const { restitution, over } = measured ? impactLabels(impacts) : { restitution: "not measured", over: "–" };
  const energy = s.kineticEnergy + s.rotationalEnergy + s.elasticEnergy + s.potentialEnergy;
  const raised = settings && now.substeps > settings.substeps;
  return [
    {
      id: "substeps",
      name: "Substeps",
      value: count(now.substeps),
      about: "Parts into which a step is divided. More of them are more exact and slower",
      warning: raised ? "More than set, because spheres move very fast" : undefined,
    },
    {
      id: "step-time",
      name: "Step time",
      value: now.stepMs > 0 ? `${figure(now.stepMs)} ms` : "–",
      about: "Time that the server takes for a step, mean of the last second",
    },
    {
      id: "overlap-mean",
      name: "Overlap, mean",
      value: percent(s.overlapMean),
      about: "How far touching spheres overlap, over the smaller radius. Hard spheres have none",
    },
    {
      id: "overlap-max",
      name: "Overlap, max",
      value: percent(s.overlapMax),
      about: "The largest overlap of two spheres, over the smaller radius",
    },
    {
      id: "restitution",
      name: "Restitution",
      value: restitution,
      about:
        "Speed after an impact over speed before it: as measured, and as the materials specify. It is lower than " +
        "specified if a sphere has several impacts within a substep",
    },
    {
      id: "impacts",
      name: "Impacts",
      value: over,
      about: "Impacts of two spheres from which the restitution is measured, in every 16th step",
    },
    {
      id: "energy",
      name: "Energy",
      value: `${now.energyRises ? "rises: " : ""}${joules(energy)}`,
      about: "Kinetic, rotational, elastic and potential energy together",
      warning: now.energyRises
        ? "The energy increases without a source: use more substeps or another model"
        : undefined,
    },
    { id: "speed-max", name: "Speed, max", value: `${figure(s.speedMax)} m/s`, about: "Speed of the fastest sphere" },
  ];
}

function motion(s: Statistics): Figure[] {
  return [
    {
      id: "wall-overlap",
      name: "Wall overlap, max",
      value: percent(s.wallOverlapMax),
      about: "How deep a sphere is in a wall or an obstacle, over its radius",
    },
    { id: "contacts", name: "Contacts", value: count(s.contacts), about: "Pairs of spheres that touch" },
    { id: "kinetic", name: "Kinetic energy", value: joules(s.kineticEnergy), about: "Energy of the speeds" },
    { id: "rotational", name: "Rotational energy", value: joules(s.rotationalEnergy), about: "Energy of the spins" },
    {
      id: "elastic",
      name: "Elastic energy",
      value: joules(s.elasticEnergy),
      about: "Energy in the springs of contacts. Only the model Accurate has springs",
    },
    {
      id: "potential",
      name: "Potential energy",
      value: joules(s.potentialEnergy),
      about: "Energy in gravity, above the floor of the bounds, and in fields. A periodic axis has none",
    },
    { id: "momentum", name: "Momentum, N s", value: vector(s.momentum), about: "Sum over all spheres" },
    { id: "speed-rms", name: "Speed, rms", value: `${figure(s.speedRms)} m/s`, about: "Root mean square" },
    {
      id: "height",
      name: "Mean height",
      value: length(s.meanHeight),
      about: "Height of the centres above the floor of the bounds",
    },
    {
      id: "sleeping",
      name: "Asleep",
      value: count(s.sleeping),
      about: "Spheres at rest. They cost no computation until something wakes them",
    },
    {
      id: "outside",
      name: "Outside",
      value: count(s.outside),
      about: "Spheres that left the bounds through an open face",
    },
    {
      id: "non-finite",
      name: "Non-finite",
      value: count(s.nonFinite),
      about: "Spheres whose position or speed is no number. If there is one, the server pauses",
    },
  ];
}

/** The spheres that came and went; nothing if none went. */
function turnover({ born, removed }: Statistics): Figure[] {
  if (removed === 0n) return [];
  return [
    {
      id: "born",
      name: "Born",
      value: count(born),
      about: "All spheres since the beginning, the first ones included",
    },
    {
      id: "removed",
      name: "Removed",
      value: count(removed),
      about: "Spheres that commands and sinks have taken away",
    },
  ];
}

/** The spheres that have passed emitters and sinks. */
function flows({ emitters, sinks }: Statistics): Figure[] {
  const flow = (one: FlowCounts | undefined): string =>
    `${count(one?.spheres ?? 0n)}, ${figure(one?.spheresPerSecond ?? 0)}/s`;
  const made = emitters.map(({ name, born, blocked }, k): Figure => ({
    id: `emitter-${k}`,
    name: `Made by ${name || `emitter ${k}`}`,
    value: flow(born) + (blocked > 0n ? `, ${count(blocked)} blocked` : ""),
    about: "Spheres that it has made, and how many in the last second. Blocked ones found no free place",
  }));
  const taken = sinks.map((sink, k): Figure => ({
    id: `sink-${k}`,
    name: `Taken by sink ${k}`,
    value: flow(sink.taken),
    about: "Spheres that it has taken, and how many in the last second",
  }));
  return [...made, ...taken];
}

const shownForces = 12;

/** Sums over the contacts, in a scene with contact sums; nothing in others. */
function sums({ collisions, dissipatedEnergy, surfaceForces }: Statistics): Figure[] {
  if (collisions === undefined) return [];
  const components = (values: readonly number[]): string => values.map(figure).join("  ");
  const forces = surfaceForces.slice(0, shownForces).flatMap(({ surface, force, torque }): Figure[] => [
    {
      id: `force-${surface}`,
      name: `Force on ${surface},\u00a0N`,
      value: components(force),
      about: "The spheres exert it on this wall or obstacle, along x, y and z. Mean of the last second",
    },
    {
      id: `torque-${surface}`,
      name: `Torque on ${surface},\u00a0N\u00a0m`,
      value: components(torque),
      about: "The spheres exert it, about the centre of the bounds, around x, y and z. Mean of the last second",
    },
  ]);
  const more = surfaceForces.length - shownForces;
  const further = { id: "more-forces", name: "Further surfaces", value: count(more), about: "See /metrics" };
  return [
    {
      id: "collisions",
      name: "Collisions",
      value: count(collisions),
      about: "Between spheres, since they were last placed or added",
    },
    {
      id: "dissipated",
      name: "Dissipated energy",
      value: joules(dissipatedEnergy ?? 0),
      about: "Energy that contacts have turned into heat, since spheres were last placed or added",
    },
    ...forces,
    ...(more > 0 ? [further] : []),
  ];
}

function progress(s: Statistics): Figure[] {
  return [
    { id: "step", name: "Step", value: count(s.step), about: "Steps since the start of the scene" },
    { id: "time", name: "Simulated time", value: seconds(s.simTime), about: "Since the start of the scene" },
  ];
}
