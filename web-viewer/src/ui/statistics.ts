import type { Statistics } from "../gen/spherule/v1/control_pb";
import { h } from "./dom";
import { count, figure, seconds, vector } from "./format";

/** The figures of a query, as a small table. */
export class StatisticsTable {
  readonly element = h("table", { class: "statistics", "data-testid": "statistics", hidden: true });

  show(s: Statistics): void {
    const percent = (share: number): string => `${figure(100 * share)} %`;
    const rows: [string, string, string][] = [
      ["step", "Step", count(Number(s.step))],
      ["time", "Simulated", seconds(s.simTime)],
      ["kinetic", "Kinetic energy", `${figure(s.kineticEnergy)} J`],
      ["potential", "Potential energy", `${figure(s.potentialEnergy)} J`],
      ["momentum", "Momentum, N s", vector(s.momentum)],
      ["contacts", "Contacts", count(Number(s.contacts))],
      ["overlap-mean", "Overlap, mean", percent(s.overlapMean)],
      ["overlap-max", "Overlap, most", percent(s.overlapMax)],
      ["wall-overlap", "Into walls, most", percent(s.wallOverlapMax)],
      ["speed-rms", "Speed, rms", `${figure(s.speedRms)} m/s`],
      ["speed-max", "Speed, most", `${figure(s.speedMax)} m/s`],
      ["height", "Mean height", `${figure(s.meanHeight)} m`],
      ["sleeping", "Asleep", count(s.sleeping)],
      ["outside", "Outside", count(s.outside)],
      ["non-finite", "Not finite", count(s.nonFinite)],
    ];
    this.element.hidden = false;
    this.element.replaceChildren(
      ...rows.map(([id, name, value]) => h("tr", {}, h("th", {}, name), h("td", { "data-testid": `statistics-${id}` }, value))),
    );
  }
}
