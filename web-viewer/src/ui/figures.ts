import { sentence } from "../format";
import { h, setText } from "./dom";

/** A figure of the panel. `about`: what it is, for people who ask; `warning`: why the value is highlighted. */
export interface Figure {
  id: string;
  name: string;
  value: string;
  about: string;
  warning?: string | undefined;
}

/** A list of figures. A figure that is clicked, tapped or chosen with keys shows its explanation. */
export class Figures {
  readonly element = h("div", { class: "figures", hidden: true });
  private readonly rows = new Map<string, FigureRow>();
  private shown = ""; // ids of the figures

  /** The test id of a value is `PREFIX-ID`. */
  constructor(private readonly prefix: string) {}

  show(figures: Figure[]): void {
    this.element.hidden = figures.length === 0;
    const rows = figures.map((figure) => this.rowOf(figure));
    const ids = figures.map(({ id }) => id).join(" ");
    if (ids === this.shown) return;
    this.shown = ids;
    this.element.replaceChildren(...rows.map(({ element }) => element));
  }

  private rowOf(figure: Figure): FigureRow {
    const row = this.rows.get(figure.id) ?? new FigureRow(`${this.prefix}-${figure.id}`);
    this.rows.set(figure.id, row);
    row.show(figure);
    return row;
  }
}

class FigureRow {
  private readonly name = h("span");
  private readonly value: HTMLElement;
  private readonly warning = h("strong");
  private readonly about = h("span");
  readonly element: HTMLElement;

  constructor(testId: string) {
    this.value = h("b", { "data-testid": testId });
    const explanation = h("p", {}, this.warning, this.about);
    this.element = h("details", {}, h("summary", {}, this.name, this.value), explanation);
  }

  show({ name, value, about, warning = "" }: Figure): void {
    setText(this.name, name);
    setText(this.value, value);
    setText(this.warning, warning && `${sentence(warning)} `);
    setText(this.about, sentence(about));
    this.value.classList.toggle("warning", warning !== "");
  }
}
