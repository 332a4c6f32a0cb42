import type { Commands } from "../connection/commands";
import { h, icon } from "./dom";

const icons = {
  play: "M6.5 4.2v11.6L16 10z",
  pause: "M6 4.5h2.8v11H6zM11.2 4.5H14v11h-2.8z",
  step: "M5 4.5v11L12.5 10zM13.4 4.5h2v11h-2z",
  reset: "M4.2 10a5.8 5.8 0 1 0 1.9-4.3M6.3 2.6v3.6h3.6",
  home: "M3.5 9.5 10 4l6.5 5.5M5.5 8.5V16h9V8.5",
  panel: "M4 6h7M14.5 6H16M4 10h2M9.5 10H16M4 14h6M13.5 14H16M12.7 4.5v3M7.7 8.5v3M11.7 12.5v3",
  help: "M7.6 7.6a2.4 2.4 0 1 1 3.6 2.1c-.8.5-1.2.9-1.2 1.9M10 14.3v.1",
};

export interface TransportActions {
  toggle(): void;
  home(): void;
  panel(): void;
  help(): void;
}

/** Pause, step, reset; and the few buttons of the page itself. */
export class Transport {
  readonly element: HTMLElement;
  private readonly pause: HTMLButtonElement;
  private readonly steps = h("input", {
    type: "number",
    min: "1",
    max: "100000",
    value: "10",
    title: "How many steps",
    "aria-label": "Number of steps",
    "data-testid": "step-count",
  });
  private paused: boolean | undefined;

  constructor(commands: Commands, actions: TransportActions) {
    const button = (id: string, title: string, click: () => void, path: string, filled = false): HTMLButtonElement =>
      h("button", { type: "button", class: filled ? "filled" : "", title, "aria-label": title, "data-testid": id, click }, icon(path));
    this.pause = button("pause", "Pause (space)", () => actions.toggle(), icons.pause, true);
    this.pause.classList.add("main");
    const stepMany = (): void => {
      const wanted = Math.round(Number(this.steps.value));
      void commands.step(Number.isFinite(wanted) ? wanted : 0);
    };
    this.steps.addEventListener("keydown", (event) => {
      if (event.key === "Enter") stepMany();
    });
    this.element = h(
      "nav",
      { class: "transport", "aria-label": "Simulation" },
      this.pause,
      button("step", "One step (.)", () => void commands.step(1), icons.step, true),
      h("span", { class: "many" }, this.steps, h("button", { type: "button", "data-testid": "step-many", click: stepMany }, "steps")),
      button("reset", "Reset the scene (R)", () => void commands.reset(), icons.reset),
      h("span", { class: "rule" }),
      button("home", "Reset the view (F)", () => actions.home(), icons.home),
      button("help", "Keys and gestures (?)", () => actions.help(), icons.help),
      button("panel-toggle", "Controls (C)", () => actions.panel(), icons.panel),
    );
  }

  update(paused: boolean): void {
    if (paused === this.paused) return;
    this.paused = paused;
    const title = paused ? "Resume (space)" : "Pause (space)";
    this.pause.replaceChildren(icon(paused ? icons.play : icons.pause));
    this.pause.title = title;
    this.pause.setAttribute("aria-label", title);
    this.pause.dataset.paused = String(paused);
  }
}
