import type { Diagnostics, Settings } from "../gen/spherule/v1/control_pb";
import { h } from "./dom";
import { count, figure, seconds, vector } from "./format";

type Row = [id: string, name: string, value: string, warning?: string];

/** What the world is like now, as a small table. */
export class StatisticsTable {
  readonly element = h("table", { class: "statistics", "data-testid": "statistics", hidden: true });

  show(now: Diagnostics, settings: Settings | undefined): void {
    const s = now.statistics;
    if (!s) return;
    const percent = (share: number): string => `${figure(100 * share)} %`;
    const raised = settings && now.substeps > settings.substeps ? "More than set, because something moves very fast" : undefined;
    const rises = now.energyRises ? "It has risen where nothing can have given any: use more substeps or another model" : undefined;
    const rows: Row[] = [
      ["substeps", "Substeps", count(now.substeps), raised],
      ["step-time", "A step takes", now.stepMs > 0 ? `${figure(now.stepMs)} ms` : "–"],
      ["overlap-mean", "Overlap, mean", percent(s.overlapMean)],
      ["overlap-max", "Overlap, most", percent(s.overlapMax)],
      ["wall-overlap", "Into walls, most", percent(s.wallOverlapMax)],
      ["contacts", "Contacts", count(Number(s.contacts))],
      ["energy", "Energy", `${rises ? "rises: " : ""}${figure(s.kineticEnergy + s.rotationalEnergy + s.potentialEnergy)} J`, rises],
      ["kinetic", "– of motion", `${figure(s.kineticEnergy)} J`],
      ["rotational", "– of rotation", `${figure(s.rotationalEnergy)} J`],
      ["potential", "– of height", `${figure(s.potentialEnergy)} J`],
      ["momentum", "Momentum, N s", vector(s.momentum)],
      ["speed-rms", "Speed, rms", `${figure(s.speedRms)} m/s`],
      ["speed-max", "Speed, most", `${figure(s.speedMax)} m/s`],
      ["height", "Mean height", `${figure(s.meanHeight)} m`],
      ["sleeping", "Asleep", count(s.sleeping)],
      ["outside", "Outside", count(s.outside)],
      ["non-finite", "Not finite", count(s.nonFinite)],
      ["step", "Step", count(Number(s.step))],
      ["time", "Simulated", seconds(s.simTime)],
    ];
    this.element.hidden = false;
    this.element.replaceChildren(...rows.map(rowOf));
  }
}

function rowOf([id, name, value, warning]: Row): HTMLElement {
  const figures = h("td", { class: warning ? "warning" : "", title: warning ?? "", "data-testid": `statistics-${id}` }, value);
  return h("tr", {}, h("th", {}, name), figures);
}
