import type { Diagnostics, Settings, Statistics } from "../gen/spherule/v1/control_pb";
import { Model } from "../gen/spherule/v1/scene_pb";
import { count, figure, length, seconds, vector, withPrefix } from "../format";
import { impactLabels, mergeImpacts } from "./dial_labels";
import type { Impacts } from "./dial_labels";
import { fillTable, h } from "./dom";
import type { Row } from "./dom";

const impactTitle =
  "Measured over impacts of two spheres, in every 16th step. It is lower than specified if a sphere has several " +
  "impacts within a substep";

/** The diagnostics in two tables: the figures that belong to the dial, and the others. */
export class StatisticsTables {
  readonly quality = h("table", { class: "statistics", hidden: true });
  readonly rest = h("table", { class: "statistics", hidden: true });

  /** The last impacts reported: if impacts are rare, most reports have none. */
  private impacts: Impacts | undefined;
  private step = 0n;

  show(now: Diagnostics, settings: Settings | undefined): void {
    const s = now.statistics;
    if (!s) return;
    const percent = (share: number): string => `${figure(100 * share)} %`;
    const raised =
      settings && now.substeps > settings.substeps ? "More than set, because spheres move very fast" : undefined;
    const rises = now.energyRises
      ? "The energy increases without a source: use more substeps or another model"
      : undefined;
    if (s.step < this.step) this.impacts = undefined; // another scene
    this.step = s.step;
    this.impacts = mergeImpacts(this.impacts, s);
    const measured = settings?.model !== Model.ACCURATE;
    const { restitution, over } = measured
      ? impactLabels(this.impacts)
      : { restitution: "not measured", over: "–" };
    const energy = s.kineticEnergy + s.rotationalEnergy + s.elasticEnergy + s.potentialEnergy;
    fillTable(this.quality, "statistics", [
      ["substeps", "Substeps", count(now.substeps), raised],
      ["step-time", "Step time", now.stepMs > 0 ? `${figure(now.stepMs)} ms` : "–"],
      ["overlap-mean", "Overlap, mean", percent(s.overlapMean)],
      ["overlap-max", "Overlap, max", percent(s.overlapMax)],
      ["restitution", "Restitution", restitution, undefined, impactTitle],
      ["impacts", "Impacts", over, undefined, impactTitle],
      ["energy", "Energy", `${rises ? "rises: " : ""}${withPrefix(energy, "J")}`, rises],
      ["speed-max", "Speed, max", `${figure(s.speedMax)} m/s`],
    ]);
    fillTable(this.rest, "statistics", [
      ["wall-overlap", "Wall overlap, max", percent(s.wallOverlapMax)],
      ["contacts", "Contacts", count(s.contacts)],
      ["kinetic", "Kinetic energy", withPrefix(s.kineticEnergy, "J")],
      ["rotational", "Rotational energy", withPrefix(s.rotationalEnergy, "J")],
      ["elastic", "Elastic energy", withPrefix(s.elasticEnergy, "J")],
      ["potential", "Potential energy", withPrefix(s.potentialEnergy, "J")],
      ["momentum", "Momentum, N s", vector(s.momentum)],
      ["speed-rms", "Speed, rms", `${figure(s.speedRms)} m/s`],
      ["height", "Mean height", length(s.meanHeight)],
      ["sleeping", "Asleep", count(s.sleeping)],
      ["outside", "Outside", count(s.outside)],
      ["non-finite", "Non-finite", count(s.nonFinite)],
      ...turnover(s),
      ...sums(s),
      ["step", "Step", count(s.step)],
      ["time", "Simulated time", seconds(s.simTime)],
    ]);
  }
}

const shownForces = 12;
const torqueTitle = "About the centre of the bounds, mean of the last second";

/** Sums over the contacts, in a scene with contact sums; no rows in others. */
function sums({ collisions, dissipatedEnergy, surfaceForces }: Statistics): Row[] {
  if (collisions === undefined) return [];
  const rows: Row[] = [
    ["collisions", "Collisions", count(collisions), undefined, "Between spheres, so far"],
    ["dissipated", "Dissipated energy", withPrefix(dissipatedEnergy ?? 0, "J"), undefined, "By contacts, so far"],
  ];
  const components = (values: readonly number[]): string => values.map(figure).join("  ");
  for (const { surface, force, torque } of surfaceForces.slice(0, shownForces)) {
    rows.push(
      [`force-${surface}`, `Force on ${surface},\u00a0N`, components(force), undefined, "Mean of the last second"],
      [`torque-${surface}`, `Torque on ${surface},\u00a0N\u00a0m`, components(torque), undefined, torqueTitle],
    );
  }
  const more = surfaceForces.length - shownForces;
  if (more > 0) rows.push(["more-forces", "Further surfaces", count(more), undefined, "See /metrics"]);
  return rows;
}

/** The spheres that came and went; no rows if none went. */
function turnover({ born, removed }: Statistics): Row[] {
  if (removed === 0n) return [];
  return [
    ["born", "Born", count(born), undefined, "All spheres since the beginning, the first ones included"],
    ["removed", "Removed", count(removed)],
  ];
}
