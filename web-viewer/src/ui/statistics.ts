import type { Diagnostics, Settings } from "../gen/spherule/v1/control_pb";
import { Model } from "../gen/spherule/v1/scene_pb";
import { impactWords, moreImpacts } from "./dial_words";
import type { Impacts } from "./dial_words";
import { h } from "./dom";
import { count, figure, seconds, vector } from "./format";
import { fill } from "./table";

const seen = "Of spheres that met spheres, seen in every 16th step: less than asked where one meets several within a substep";

/** What the world is like now, as two small tables: what goes with the dial, and the rest. */
export class StatisticsTables {
  readonly quality = h("table", { class: "statistics", hidden: true });
  readonly rest = h("table", { class: "statistics", hidden: true });

  /** The last impacts that were told: where they are rare, most reports have none. */
  private impacts: Impacts | undefined;
  private step = 0n;

  show(now: Diagnostics, settings: Settings | undefined): void {
    const s = now.statistics;
    if (!s) return;
    const percent = (share: number): string => `${figure(100 * share)} %`;
    const raised = settings && now.substeps > settings.substeps ? "More than set, because something moves very fast" : undefined;
    const rises = now.energyRises ? "It has risen where nothing can have given any: use more substeps or another model" : undefined;
    if (s.step < this.step) this.impacts = undefined; // another scene
    this.step = s.step;
    this.impacts = moreImpacts(this.impacts, s);
    const unseen = settings?.model === Model.ACCURATE;
    const { restitution, over } = unseen ? { restitution: "not observed", over: "–" } : impactWords(this.impacts);
    const energy = s.kineticEnergy + s.rotationalEnergy + s.elasticEnergy + s.potentialEnergy;
    fill(this.quality, "statistics", [
      ["substeps", "Substeps", count(now.substeps), raised],
      ["step-time", "A step takes", now.stepMs > 0 ? `${figure(now.stepMs)} ms` : "–"],
      ["overlap-mean", "Overlap, mean", percent(s.overlapMean)],
      ["overlap-max", "Overlap, most", percent(s.overlapMax)],
      ["restitution", "Restitution", restitution, undefined, seen],
      ["impacts", "Over impacts", over, undefined, seen],
      ["energy", "Energy", `${rises ? "rises: " : ""}${figure(energy)} J`, rises],
      ["speed-max", "Speed, most", `${figure(s.speedMax)} m/s`],
    ]);
    fill(this.rest, "statistics", [
      ["wall-overlap", "Into walls, most", percent(s.wallOverlapMax)],
      ["contacts", "Contacts", count(Number(s.contacts))],
      ["kinetic", "Energy of motion", `${figure(s.kineticEnergy)} J`],
      ["rotational", "Energy of rotation", `${figure(s.rotationalEnergy)} J`],
      ["elastic", "Energy of springs", `${figure(s.elasticEnergy)} J`],
      ["potential", "Energy of height", `${figure(s.potentialEnergy)} J`],
      ["momentum", "Momentum, N s", vector(s.momentum)],
      ["speed-rms", "Speed, rms", `${figure(s.speedRms)} m/s`],
      ["height", "Mean height", `${figure(s.meanHeight)} m`],
      ["sleeping", "Asleep", count(s.sleeping)],
      ["outside", "Outside", count(s.outside)],
      ["non-finite", "Not finite", count(s.nonFinite)],
      ["step", "Step", count(Number(s.step))],
      ["time", "Simulated", seconds(s.simTime)],
    ]);
  }
}
