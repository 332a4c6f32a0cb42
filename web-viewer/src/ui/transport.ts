import { effect } from "@preact/signals-core";
import type { Session } from "../model/session";
import { h, icon } from "./dom";

const icons = {
  play: "M6.5 4.2v11.6L16 10z",
  pause: "M6 4.5h2.8v11H6zM11.2 4.5H14v11h-2.8z",
  step: "M5 4.5v11L12.5 10zM13.4 4.5h2v11h-2z",
  begin: "M4.6 4.5h2v11h-2zM15 4.5v11L7.5 10z",
  reset: "M4.2 10a5.8 5.8 0 1 0 1.9-4.3M6.3 2.6v3.6h3.6",
  home: "M3.5 9.5 10 4l6.5 5.5M5.5 8.5V16h9V8.5",
  panel: "M4 6h7M14.5 6H16M4 10h2M9.5 10H16M4 14h6M13.5 14H16M12.7 4.5v3M7.7 8.5v3M11.7 12.5v3",
  help: "M7.6 7.6a2.4 2.4 0 1 1 3.6 2.1c-.8.5-1.2.9-1.2 1.9M10 14.3v.1",
};

export interface TransportActions {
  toggle(): void;
  step(count: number): void;
  reset(): void;
  home(): void;
  panel(): void;
  help(): void;
}

/** The button bar: pause, step, reset, record, and the buttons of the page itself. */
export class Transport {
  readonly element: HTMLElement;
  private readonly pause: HTMLButtonElement;
  private readonly step: HTMLButtonElement;
  private readonly reset: HTMLButtonElement;
  private readonly steps = h("input", {
    type: "number",
    min: "1",
    max: "100000",
    value: "10",
    "data-testid": "step-count",
  });
  private readonly unit: HTMLButtonElement;

  /** `blocked`: why the user may not send commands; empty if they may. `suffix`: of the name of its region. */
  constructor(
    private readonly session: Session,
    private readonly blocked: () => string,
    record: HTMLElement,
    actions: TransportActions,
    private readonly suffix: string,
  ) {
    const button = (id: string, click: () => void, path: string, filled = false): HTMLButtonElement =>
      h("button", { type: "button", class: filled ? "filled" : "", "data-testid": id, click }, icon(path));
    this.pause = button("pause", () => actions.toggle(), icons.pause, true);
    this.pause.classList.add("main");
    this.step = button("step", () => actions.step(1), icons.step, true);
    const stepMany = (): void => {
      const count = Math.round(Number(this.steps.value));
      actions.step(Number.isFinite(count) ? count : 0);
    };
    this.steps.addEventListener("keydown", (event) => {
      if (event.key === "Enter") stepMany();
    });
    this.unit = h("button", { type: "button", "data-testid": "step-many", click: stepMany });
    this.reset = button("reset", () => actions.reset(), icons.reset);
    this.element = h(
      "section",
      { class: "transport" },
      this.pause,
      this.step,
      h("span", { class: "many" }, this.steps, this.unit),
      this.reset,
      record,
      h("span", { class: "rule" }),
      named(
        button("home", () => actions.home(), icons.home),
        "Reset the view (F)",
      ),
      named(
        button("help", () => actions.help(), icons.help),
        "Keys and gestures (?)",
      ),
      named(
        button("panel-toggle", () => actions.panel(), icons.panel),
        "Controls (C)",
      ),
    );
    effect(() => this.describe());
  }

  private describe(): void {
    const { playing, paused, replay } = this.session;
    const blockedReason = this.blocked();
    const unit = playing || replay ? "frame" : "step";
    const reason = replay ? "" : blockedReason; // of pause and steps; in a replay, they need no server
    this.element.setAttribute("aria-label", (playing ? "Playback" : "Simulation") + this.suffix);
    named(this.step, `One ${unit} (.)`, reason);
    this.steps.title = reason || `Number of ${unit}s`;
    this.steps.setAttribute("aria-label", `Number of ${unit}s`);
    this.unit.textContent = `${unit}s`;
    this.unit.title = reason;
    named(this.reset, playing ? "Go to the beginning (R)" : "Reset the scene (R)", blockedReason);
    this.reset.replaceChildren(icon(playing ? icons.begin : icons.reset));
    this.reset.classList.toggle("filled", playing);
    this.pause.replaceChildren(icon(paused ? icons.play : icons.pause));
    named(this.pause, paused ? "Resume (space)" : "Pause (space)", reason);
    this.pause.dataset.paused = String(paused);
    for (const control of [this.pause, this.step, this.steps, this.unit]) control.disabled = reason !== "";
    this.reset.disabled = blockedReason !== "";
  }
}

/** Sets a button's name, which is its tooltip unless there is a reason why it is disabled. */
function named(button: HTMLButtonElement, name: string, blockedReason = ""): HTMLButtonElement {
  button.title = blockedReason || name;
  button.setAttribute("aria-label", name);
  return button;
}
