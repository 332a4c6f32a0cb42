import type { Session } from "../model/session";
import { bytesPerSecond, count, figure, seconds } from "../format";
import { h, setText } from "./dom";
import { reductionLabel } from "./stream_labels";

/** The status line at the foot of the page. */
export class StatusLine {
  private readonly fields = new Map<string, HTMLElement>();
  private readonly spheresUnit = h("span", {}, "spheres");
  readonly element: HTMLElement;

  constructor(private readonly session: Session) {
    this.element = h(
      "footer",
      { "data-testid": "status" },
      this.field("spheres", this.spheresUnit, "Spheres in the scene"),
      this.field("time", "simulated", "Simulated time since the start of the scene"),
      this.field("factor", "real time", "Simulated seconds per second; lower than requested if the server is slow"),
      this.field("steps", "steps/s", "Steps per second"),
      this.field("asleep", "asleep", "Spheres at rest, which cost no computation"),
      this.field("outside", "outside", "Spheres that left the bounds through an open face"),
      this.field("stream", "stream", "States per second, and their bandwidth"),
      this.field("fps", "fps drawn", "Images per second; none while nothing changes"),
      this.field("viewers", "viewers", "Clients connected to this server"),
      this.field("renderer", "", "Device of the simulation"),
    );
  }

  /** `now`: ms; `current`: the session's figures are current. */
  update(now: number, fps: number, current: boolean): void {
    const { session } = this;
    const { facts, status, welcome, newest } = session;
    const spheres = facts?.population.count;
    this.set("spheres", spheres === undefined ? "–" : count(spheres));
    setText(this.spheresUnit, spheres === 1 ? "sphere" : "spheres");
    this.set("time", newest ? seconds(newest.simTime) : "–");
    const plays = session.timeline !== undefined; // a recording: nothing is simulated
    const factor = plays ? session.settings?.speed : status?.realTimeFactor;
    const paused = current && session.paused;
    this.set("factor", paused ? "paused" : current && factor !== undefined ? `${figure(factor)} ×` : "–");
    this.fields.get("factor")?.parentElement?.toggleAttribute("data-alone", paused);
    this.set("steps", current && status ? figure(status.stepsPerSecond) : "–", plays);
    const asleep = status && spheres ? `${Math.round((100 * status.sleeping) / spheres)} %` : "–";
    this.set("asleep", asleep, plays);
    this.set("outside", status ? count(status.outside) : "0", !status?.outside);
    const rates = session.traffic.rates(now);
    this.set("stream", current ? `${rates.frames.toFixed(0)}/s  ${bytesPerSecond(rates.bytes)}` : "–");
    const reason = reductionLabel(session.stream);
    this.setTitle("stream", `States per second, and their bandwidth. ${reason}`.trim());
    this.set("fps", fps > 0 ? fps.toFixed(0) : "idle");
    this.set("viewers", current && status ? count(status.viewers) : "–", (status?.viewers ?? 0) < 2);
    this.set("renderer", welcome ? [welcome.device, welcome.renderer].filter(Boolean).join(" · ") : "");
    if (welcome) this.setTitle("renderer", `Device of the simulation: ${welcome.reason}`);
  }

  private field(id: string, label: string | HTMLElement, title: string): HTMLElement {
    const value = h("b", { "data-testid": `status-${id}` });
    this.fields.set(id, value);
    return h("span", { class: `field ${id}`, title }, value, typeof label === "string" ? h("span", {}, label) : label);
  }

  private setTitle(id: string, title: string): void {
    this.fields.get(id)?.parentElement?.setAttribute("title", title);
  }

  private set(id: string, text: string, hidden = false): void {
    const field = this.fields.get(id);
    if (!field) return;
    setText(field, text);
    if (field.parentElement) field.parentElement.hidden = hidden;
  }
}
