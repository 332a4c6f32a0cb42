import type { Session } from "../scene/session";
import { h, setText } from "./dom";
import { bytesPerSecond, count, figure, seconds } from "./format";
import { reductionWords } from "./stream_words";

/** One line of figures at the foot of the page. */
export class StatusLine {
  private readonly fields = new Map<string, HTMLElement>();
  readonly element: HTMLElement;

  constructor(private readonly session: Session) {
    this.element = h(
      "footer",
      { "data-testid": "status" },
      this.field("spheres", "spheres", "Spheres in the world"),
      this.field("time", "simulated", "Simulated time since the start of the scene"),
      this.field("factor", "real time", "Simulated seconds per second; below the speed asked for, the machine cannot keep up"),
      this.field("steps", "steps/s", "Steps per second"),
      this.field("asleep", "asleep", "Spheres at rest that are not computed"),
      this.field("outside", "outside", "Spheres that left the bounds through an open face"),
      this.field("stream", "stream", "States per second and their bytes"),
      this.field("fps", "fps drawn", "Pictures per second; none while nothing changes"),
      this.field("viewers", "viewers", "Pages that watch this world"),
      this.field("renderer", "", "What computes the world"),
    );
  }

  update(now: number, fps: number): void {
    const { session } = this;
    const { facts, status, welcome, states } = session;
    this.set("spheres", facts ? count(facts.count) : "–");
    this.set("time", states.newest ? seconds(states.newest.simTime) : "–");
    const plays = session.timeline !== undefined; // then nothing is computed
    const factor = plays ? session.settings?.speed : status?.realTimeFactor;
    this.set("factor", session.paused ? "paused" : factor === undefined ? "–" : `${figure(factor)} ×`);
    this.fields.get("factor")?.parentElement?.toggleAttribute("data-alone", session.paused);
    this.set("steps", status ? figure(status.stepsPerSecond) : "–", plays);
    this.set("asleep", status && facts?.count ? `${Math.round((100 * status.sleeping) / facts.count)} %` : "–", plays);
    this.set("outside", status ? count(status.outside) : "0", !status?.outside);
    const rates = session.traffic.rates(now);
    this.set("stream", session.live ? `${rates.frames.toFixed(0)}/s  ${bytesPerSecond(rates.bytes)}` : "–");
    const reason = reductionWords(session.stream);
    this.fields.get("stream")?.parentElement?.setAttribute("title", `States per second and their bytes. ${reason}`.trim());
    this.set("fps", fps > 0 ? fps.toFixed(0) : "idle");
    this.set("viewers", status ? count(status.viewers) : "–", (status?.viewers ?? 0) < 2);
    this.set("renderer", welcome ? [welcome.device, welcome.renderer].filter(Boolean).join(" · ") : "");
    if (welcome) this.fields.get("renderer")?.parentElement?.setAttribute("title", `What computes the world: ${welcome.reason}`);
  }

  private field(id: string, label: string, title: string): HTMLElement {
    const value = h("b", { "data-testid": `status-${id}` });
    this.fields.set(id, value);
    return h("span", { class: `field ${id}`, title }, value, h("span", {}, label));
  }

  private set(id: string, text: string, hidden = false): void {
    const field = this.fields.get(id);
    if (!field) return;
    setText(field, text);
    if (field.parentElement) field.parentElement.hidden = hidden;
  }
}
