import { effect } from "@preact/signals-core";
import type { Outcome } from "../connection/link";
import type { Dial as DialMessage, DialPosition } from "../gen/spherule/v1/diagnostics_pb";
import type { Session } from "../model/session";
import { observed } from "../observed";
import { live } from "./bindings";
import { costFigures, errorFigures, modelName, models, nearest, substepLabel } from "./dial_labels";
import { h, setText } from "./dom";
import { Figures } from "./figures";
import type { Figure } from "./figures";

/** The quality dial, from fast to accurate. Shows the measured errors of a position, and its cost on this server. */
export class Dial {
  private readonly slider = h("input", {
    type: "range",
    min: "0",
    step: "1",
    "data-testid": "dial",
    "aria-label": "Quality",
  });
  private readonly model = h("b", { "data-testid": "dial-model" });
  private readonly substeps = h("span", { "data-testid": "dial-substeps" });
  private readonly scale = h("div", { class: "marks", "aria-hidden": "true" });
  private readonly figures = new Figures("dial");
  private readonly note = h("p", { "data-testid": "dial-note" });
  readonly element = h(
    "div",
    { class: "dial", hidden: true },
    h("div", { class: "reading" }, this.model, this.substeps),
    this.slider,
    this.scale,
    this.figures.element,
    this.note,
  );
  @observed private accessor dragging = false; // the user moves the slider: messages of the server do not move it

  /** `blocked`: why the user may not turn the dial; empty if they may. */
  constructor(
    private readonly session: Session,
    blocked: () => string,
    turned: (position: DialPosition) => Promise<Outcome>,
  ) {
    this.slider.addEventListener("input", () => {
      this.dragging = true;
      this.describe();
    });
    this.slider.addEventListener("change", () => {
      const position = this.session.dial?.positions[this.slider.valueAsNumber];
      if (!position) return;
      void turned(position).then((outcome) => {
        if (outcome.case !== "applied") this.show();
      });
      this.dragging = false;
    });
    // There is no change event if the slider is released where it was.
    for (const end of ["pointerup", "keyup", "blur"]) {
      this.slider.addEventListener(end, () => (this.dragging = false));
    }
    live(this.element, { hidden: () => !session.dial || !session.settings });
    live(this.slider, { disabled: () => blocked() !== "", title: blocked });
    effect(() => {
      if (session.dial) this.drawScale(session.dial);
    });
    effect(() => {
      if (blocked()) this.dragging = false; // a disabled slider has no further events
    });
    effect(() => this.show());
  }

  private show(): void {
    const { dial, settings } = this.session;
    if (!dial || !settings) return;
    if (!this.dragging) this.slider.valueAsNumber = Math.max(0, nearest(dial, settings.model, settings.substeps));
    this.describe();
  }

  /** Shows the position under the slider while it is dragged, else the present settings. */
  private describe(): void {
    const { dial, settings } = this.session;
    if (!dial || !settings) return;
    const index = this.dragging ? this.slider.valueAsNumber : nearest(dial, settings.model, settings.substeps);
    const position = dial.positions[index];
    const { model, substeps } = this.dragging && position ? position : settings;
    setText(this.model, modelName(model));
    setText(this.substeps, `${substepLabel(substeps)} a step`);
    this.model.title = models.find((one) => one.model === model)?.description ?? "";
    const errors = position ? errorFigures(position) : [];
    const costs = position ? costFigures(position, substeps, dial.calibrated, settings) : [];
    const valueText = [...errors, ...costs].map(({ name, value }) => `${name} ${value}`).join(", ");
    this.slider.setAttribute("aria-valuetext", `${modelName(model)}, ${substepLabel(substeps)}: ${valueText}`);
    const source = (figure: Figure): Figure => ({ ...figure, about: `${figure.about}. On ${dial.measuredOn}` });
    this.figures.show([...errors.map(source), ...costs]);
    const measured =
      position && position.substeps !== substeps
        ? [`Errors are those measured with ${substepLabel(position.substeps)}.`]
        : [];
    const missing = dial.missing.map((one) => `${modelName(one.model)} is not available: ${one.reason}.`);
    setText(this.note, [...measured, ...missing].join(" "));
    this.note.hidden = this.note.textContent === "";
  }

  private drawScale({ positions }: DialMessage): void {
    this.slider.max = String(Math.max(0, positions.length - 1));
    const share = (index: number): string => `left: ${(100 * index) / Math.max(1, positions.length - 1)}%`;
    const ticks = positions.map((_, i) => h("i", { style: share(i) }));
    const names = models.flatMap(({ model, name }) => {
      const own = positions.flatMap((position, i) => (position.model === model ? [i] : []));
      if (own.length === 0) return [];
      return [h("span", { style: share(own.reduce((sum, i) => sum + i, 0) / own.length) }, name)];
    });
    this.scale.replaceChildren(...ticks, ...names);
  }
}
