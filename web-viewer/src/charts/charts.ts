import uPlot from "uplot";
import plotStyle from "uplot/dist/uPlot.min.css";
import { figure, seconds } from "../format";
import type { Sample, Samples } from "../model/samples";
import { adoptStyle } from "../ui/parts";
import style from "./charts.css";
import { chartKinds } from "./chart_list";
import type { ChartKind, Series } from "./chart_list";

// This file and the chart library are loaded when the folder of the charts is opened for the first time.

const height = 170; // CSS pixels
const colours = 8; // in charts.css
const dashes = [[], [6, 3], [2, 2], [8, 3, 2, 3], [], [6, 3], [2, 2], [8, 3, 2, 3]];

function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  made.append(...children);
  return made;
}

/** A chart chosen from a list, and a table of its newest values. */
export class Charts {
  private readonly select = element("select");
  private readonly host = element("div");
  private readonly table = element("table");
  private kind: ChartKind = chartKinds[0] as ChartKind;
  private plot: uPlot | undefined;
  private drawn = ""; // what the plot shows
  private series: Series[] = [];

  /** `parent`: the element to fill. */
  constructor(private readonly parent: HTMLElement) {
    for (const sheet of [plotStyle, style]) adoptStyle(sheet);
    parent.classList.add("charts");
    this.select.setAttribute("aria-label", "Chart");
    this.select.dataset.testid = "chart";
    this.select.append(...chartKinds.map(({ name }) => element("option", name)));
    this.select.addEventListener("change", () => {
      this.kind = chartKinds[this.select.selectedIndex] as ChartKind;
      this.drawn = "";
    });
    this.host.className = "chart";
    this.host.setAttribute("role", "img");
    this.host.dataset.testid = "chart-image";
    this.table.dataset.testid = "chart-values";
    parent.append(this.select, this.host, this.table);
  }

  /** Shows the samples. Does nothing if they are shown already. */
  update(samples: Samples): void {
    const { list, version } = samples;
    const theme = this.parent.closest<HTMLElement>("[data-theme]")?.dataset.theme ?? "";
    const width = this.host.clientWidth;
    const content = [version, this.kind.name, theme, width].join(" ");
    if (content === this.drawn || width === 0) return;
    const series = this.kind.series(list.at(-1)).slice(0, colours);
    const kept = this.drawn.split(" ").slice(1).join(" ") === content.split(" ").slice(1).join(" ");
    this.drawn = content;
    const same = kept && series.length === this.series.length;
    this.series = series;
    const data: uPlot.AlignedData = [
      list.map(({ statistics }) => statistics.simTime),
      ...series.map(({ value }) => list.map((sample) => known(value(sample)))),
    ];
    if (same && this.plot) {
      this.plot.setData(data);
    } else {
      this.plot?.destroy();
      this.plot = new uPlot(this.optionsFor(width), data, this.host);
    }
    this.describe(list);
  }

  private colour(name: string): string {
    return getComputedStyle(this.parent).getPropertyValue(name).trim();
  }

  private optionsFor(width: number): uPlot.Options {
    const grid = { stroke: this.colour("--line"), width: 1 };
    const axis = { stroke: this.colour("--quiet"), grid, ticks: { show: false } };
    const { text } = this.kind;
    return {
      width,
      height,
      padding: [8, 8, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false } },
      scales: { x: { time: false } },
      axes: [
        { ...axis, size: 26, values: (_, ticks) => ticks.map((tick) => `${figure(tick)} s`) },
        { ...axis, size: 62, values: (_, ticks) => ticks.map(text) },
      ],
      series: [
        {},
        ...this.series.map(({ name }, k) => ({
          label: name,
          stroke: this.colour(`--series-${k}`),
          width: 1.5,
          dash: dashes[k] ?? [],
          points: { show: false },
        })),
      ],
    };
  }

  /** Says in words what the chart shows. */
  private describe(list: readonly Sample[]): void {
    const { name, text } = this.kind;
    const [first, last] = [list[0], list.at(-1)];
    const ends = [first, last].map((sample) => seconds(sample?.statistics.simTime ?? NaN));
    const span = `from ${ends.join(" to ")}`;
    const none = this.series.length === 0 ? "no values in this scene, or none yet" : "no values yet";
    this.host.setAttribute("aria-label", `${name}, ${last && this.series.length > 0 ? span : none}`);
    const valueText = (value = NaN): string => (Number.isFinite(value) ? text(value) : "–");
    const rows = this.series.map((one, k) => {
      const line = element("i");
      line.style.borderTopColor = `var(--series-${k})`;
      line.style.borderTopStyle = (dashes[k] ?? []).length > 0 ? "dashed" : "solid";
      const head = element("th", line, one.name);
      head.scope = "row";
      return element("tr", head, element("td", valueText(last && one.value(last))));
    });
    const caption = last && this.series.length > 0 ? `at ${seconds(last.statistics.simTime)}` : none;
    this.table.replaceChildren(element("caption", caption), ...rows);
  }
}

/** A gap for a value that is not known. */
function known(value: number): number | null {
  return Number.isFinite(value) ? value : null;
}
