import type { Dial as DialMessage, DialPosition, Settings } from "../gen/spherule/v1/control_pb";
import { costRows, errorRows, nearest, substepWords } from "./dial_words";
import { h, setText } from "./dom";
import { models, nameOf } from "./models";

/** One control from fast to accurate; each position with what was measured of it and what it costs here. */
export class Dial {
  private readonly slider = h("input", { type: "range", min: "0", step: "1", "data-testid": "dial", "aria-label": "Quality" });
  private readonly model = h("b", { "data-testid": "dial-model" });
  private readonly substeps = h("span", { "data-testid": "dial-substeps" });
  private readonly scale = h("div", { class: "marks", "aria-hidden": "true" });
  private readonly rows = h("table", { class: "statistics" });
  private readonly note = h("p", { "data-testid": "dial-note" });
  readonly element = h(
    "div",
    { class: "dial", hidden: true },
    h("div", { class: "reading" }, this.model, this.substeps),
    this.slider,
    this.scale,
    this.rows,
    this.note,
  );
  private dial: DialMessage | undefined;
  private settings: Settings | undefined;
  private turning = false; // by hand: what the server says meanwhile does not move it

  constructor(turned: (position: DialPosition) => void) {
    this.slider.addEventListener("input", () => {
      this.turning = true;
      this.describe();
    });
    this.slider.addEventListener("change", () => {
      this.turning = false;
      const position = this.dial?.positions[this.slider.valueAsNumber];
      if (position) turned(position);
    });
    // Let go where it was, there is no change to hear of.
    for (const end of ["pointerup", "keyup", "blur"])
      this.slider.addEventListener(end, () => {
        this.turning = false;
        this.show();
      });
  }

  offer(dial: DialMessage): void {
    this.dial = dial;
    this.slider.max = String(Math.max(0, dial.positions.length - 1));
    this.drawScale(dial);
    this.show();
  }

  settle(settings: Settings): void {
    this.settings = settings;
    this.show();
  }

  /** `why`: it is out of use; empty: it is not. */
  restrict(why: string): void {
    this.slider.disabled = why !== "";
    this.slider.title = why;
    if (why) this.turning = false; // nobody will hear that it was let go
    this.show();
  }

  private show(): void {
    const { dial, settings } = this;
    this.element.hidden = !dial || !settings;
    if (!dial || !settings) return;
    if (!this.turning) this.slider.valueAsNumber = Math.max(0, nearest(dial, settings.model, settings.substeps));
    this.describe();
  }

  /** What is under the hand, or else what holds. */
  private describe(): void {
    const { dial, settings } = this;
    if (!dial || !settings) return;
    const position = dial.positions[this.turning ? this.slider.valueAsNumber : nearest(dial, settings.model, settings.substeps)];
    const { model, substeps } = this.turning && position ? position : settings;
    setText(this.model, nameOf(model));
    setText(this.substeps, `${substepWords(substeps)} a step`);
    this.model.title = models.find((one) => one.model === model)?.says ?? "";
    this.rows.hidden = !position;
    const rows = position ? [...errorRows(position), ...costRows(position, substeps, dial.calibrated, settings)] : [];
    const spoken = rows.map(({ name, value }) => `${name} ${value}`).join(", ");
    this.slider.setAttribute("aria-valuetext", `${nameOf(model)}, ${substepWords(substeps)}: ${spoken}`);
    this.rows.replaceChildren(
      ...rows.map(({ id, name, title, value }) => h("tr", { title }, h("th", {}, name), h("td", { "data-testid": `dial-${id}` }, value))),
    );
    const between = position && position.substeps !== substeps ? [`Errors as measured with ${substepWords(position.substeps)}.`] : [];
    const missing = dial.missing.map((one) => `${nameOf(one.model)} is not for this scene: ${one.reason}.`);
    setText(this.note, [...between, ...missing].join(" "));
    this.note.hidden = this.note.textContent === "";
    this.rows.title = `Errors measured on ${dial.measuredOn}`;
  }

  private drawScale({ positions }: DialMessage): void {
    const share = (index: number): string => `left: ${(100 * index) / Math.max(1, positions.length - 1)}%`;
    const ticks = positions.map((_, i) => h("i", { style: share(i) }));
    const names = models.flatMap(({ model, name }) => {
      const own = positions.flatMap((position, i) => (position.model === model ? [i] : []));
      return own.length > 0 ? [h("span", { style: share(own.reduce((sum, i) => sum + i, 0) / own.length) }, name)] : [];
    });
    this.scale.replaceChildren(...ticks, ...names);
  }
}
