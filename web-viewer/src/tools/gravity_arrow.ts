import type { View } from "../camera/view";
import type { Outcome } from "../connection/link";
import { figure } from "../format";
import type { Vec3 } from "../model/facts";
import { h, setText } from "../ui/dom";
import { axesOf } from "./plane";

const svgName = "http://www.w3.org/2000/svg";
const radius = 42; // of the circle, in units of the picture of 100 x 100
const middle = 50;
const period = 100; // ms: gravity is sent at most this often
const earth = 9.81; // m/s²
const turn = Math.PI / 36; // radians per press of an arrow key
const stronger = 1.1; // per press of a key, or per notch of the wheel

const length = (v: readonly number[]): number => Math.hypot(...v);

/** Gravity as an arrow, as the camera sees it. Dragging it turns gravity; the wheel and keys change its strength. */
export class GravityArrow {
  readonly element: HTMLElement;
  private readonly svg = document.createElementNS(svgName, "svg");
  private readonly line = document.createElementNS(svgName, "path");
  private readonly text = h("span", { class: "strength" });
  private readonly buttons: HTMLButtonElement[];
  private shown: Vec3 = [0, 0, -earth]; // m/s²
  private strength = earth; // m/s²: of the last gravity that was not zero
  private direction: Vec3 = [0, 0, -1]; // of the same
  private wanted: Vec3 | undefined; // waits until it may be sent
  private due: ReturnType<typeof setTimeout> | undefined;
  private sent = -Infinity; // ms
  private dragging = false;
  private drawn = ""; // for which the arrow was drawn

  constructor(
    private readonly send: (gravity: Vec3, quiet: boolean) => Promise<Outcome>,
    private readonly blocked: () => boolean,
    private readonly view: () => View,
  ) {
    const { svg } = this;
    const attributes = {
      viewBox: "0 0 100 100",
      tabindex: "0",
      role: "slider",
      "aria-label": "Gravity",
      "aria-valuemin": "0",
      "aria-valuenow": "0",
      "data-testid": "gravity-arrow",
    };
    for (const [name, value] of Object.entries(attributes)) svg.setAttribute(name, value);
    const circle = document.createElementNS(svgName, "circle");
    for (const [name, value] of [
      ["cx", middle],
      ["cy", middle],
      ["r", radius],
    ] as const) {
      circle.setAttribute(name, String(value));
    }
    svg.append(circle, this.line);
    svg.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || this.blocked()) return;
      svg.setPointerCapture(event.pointerId);
      this.dragging = true;
      this.pointTo(event);
    });
    svg.addEventListener("pointermove", (event) => this.dragging && this.pointTo(event));
    for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => (this.dragging = false));
    svg.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        if (!this.blocked()) this.scale(event.deltaY < 0 ? stronger : 1 / stronger);
      },
      { passive: false },
    );
    svg.addEventListener("keydown", (event) => this.pressed(event));
    const button = (name: string, id: string, gravity: () => Vec3): HTMLButtonElement => {
      const click = (): void => {
        if (!this.blocked()) this.ask(gravity());
      };
      return h("button", { type: "button", "data-testid": id, click }, name);
    };
    this.buttons = [
      button("Down", "gravity-down", () => [0, 0, -this.strength]),
      button("Zero", "gravity-zero", () => [0, 0, 0]),
    ];
    this.element = h("div", { class: "gravity-arrow" }, h("div", { class: "side" }, this.text, ...this.buttons));
    this.element.prepend(svg);
  }

  /** `gravity`: as the server has it. `blockedReason`: why the user may not change it; empty if they may. */
  update(view: View, gravity: readonly number[] | undefined, blockedReason: string): void {
    if (blockedReason !== this.element.title) this.block(blockedReason);
    const [x = 0, y = 0, z = 0] = this.wanted ?? gravity ?? [];
    this.shown = [x, y, z];
    const strength = length(this.shown);
    if (strength > 0) {
      this.strength = strength;
      this.direction = this.shown.map((part) => part / strength) as Vec3;
    }
    const known = this.wanted !== undefined || gravity !== undefined;
    const key = [known, ...this.shown, ...view.forward, view.toClip[1], view.toClip[5]].join();
    if (key === this.drawn) return;
    this.drawn = key;
    this.draw(view, strength, known);
  }

  private block(reason: string): void {
    this.element.title = reason;
    this.svg.setAttribute("aria-disabled", String(reason !== ""));
    for (const button of this.buttons) button.disabled = reason !== "";
  }

  private draw(view: View, strength: number, known: boolean): void {
    const { right, up, away } = axesOf(view);
    const part = (axis: Vec3): number => axis.reduce((sum, a, k) => sum + a * (this.direction[k] ?? 0), 0);
    const [across, upwards, depth] = [part(right), part(up), part(away)];
    const tip = [middle + radius * across, middle - radius * upwards] as const;
    const flat = Math.hypot(across, upwards);
    let path = "";
    if (strength > 0 && flat < 0.15) {
      path = `M${middle - 6} ${middle}a6 6 0 1 0 12 0a6 6 0 1 0 -12 0`; // seen from its end
    } else if (strength > 0) {
      const [dx, dy] = [across / flat, -upwards / flat];
      const barb = (side: number): string =>
        `M${tip[0]} ${tip[1]}L${tip[0] - 11 * dx + side * 7 * dy} ${tip[1] - 11 * dy - side * 7 * dx}`;
      path = `M${middle} ${middle}L${tip[0]} ${tip[1]}${barb(1)}${barb(-1)}`;
    }
    this.line.setAttribute("d", path);
    const text = strength > 0 ? `${figure(strength)} m/s²` : known ? "no gravity" : "unknown";
    setText(this.text, text);
    this.svg.setAttribute("aria-valuenow", String(Number(strength.toPrecision(4))));
    const aside = flat < 0.15 ? "" : across > 0.4 * flat ? " right" : across < -0.4 * flat ? " left" : "";
    const height = flat < 0.15 ? "" : upwards > 0.4 * flat ? " up" : upwards < -0.4 * flat ? " down" : "";
    const far = Math.abs(depth) > 0.4 ? (depth > 0 ? " away" : " nearer") : "";
    this.svg.setAttribute("aria-valuetext", strength > 0 ? `${text},${height}${aside}${far} in the picture` : text);
  }

  /** The arrow points to the pointer. Beyond the circle it lies in the plane of the picture. */
  private pointTo(event: PointerEvent): void {
    const box = this.svg.getBoundingClientRect();
    const scale = 100 / box.width / radius;
    let across = (event.clientX - box.left - box.width / 2) * scale;
    let upwards = -(event.clientY - box.top - box.height / 2) * scale;
    const flat = Math.hypot(across, upwards);
    if (flat > 1) [across, upwards] = [across / flat, upwards / flat];
    const { right, up, away } = axesOf(this.view());
    const behind = away.reduce((sum, a, k) => sum + a * (this.direction[k] ?? 0), 0) < 0 ? -1 : 1;
    const depth = behind * Math.sqrt(Math.max(0, 1 - across * across - upwards * upwards));
    const to = right.map((a, k) => a * across + (up[k] ?? 0) * upwards + (away[k] ?? 0) * depth);
    this.ask(to.map((a) => a * this.strength) as Vec3);
  }

  private pressed(event: KeyboardEvent): void {
    const { forward } = this.view();
    const acts: Record<string, () => void> = {
      ArrowUp: () => this.scale(stronger),
      ArrowDown: () => this.scale(1 / stronger),
      ArrowLeft: () => this.turnAbout(forward, -turn),
      ArrowRight: () => this.turnAbout(forward, turn),
      PageUp: () => this.scale(stronger ** 5),
      PageDown: () => this.scale(stronger ** -5),
    };
    const act = acts[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    if (!this.blocked()) act();
  }

  private scale(factor: number): void {
    const now = length(this.shown);
    const to = now > 0 ? now * factor : this.strength;
    this.ask(this.direction.map((part) => part * Math.min(to, 1e6)) as Vec3);
  }

  /** Turns gravity clockwise in the picture. */
  private turnAbout([x, y, z]: Vec3, angle: number): void {
    const [a, b, c] = this.direction;
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    const dot = (a * x + b * y + c * z) * (1 - cos);
    const to = [
      a * cos + (y * c - z * b) * sin + x * dot,
      b * cos + (z * a - x * c) * sin + y * dot,
      c * cos + (x * b - y * a) * sin + z * dot,
    ];
    this.ask(to.map((part) => part * this.strength) as Vec3);
  }

  private ask(gravity: Vec3): void {
    this.wanted = gravity.map((part) => Number(part.toPrecision(6))) as Vec3;
    if (this.due !== undefined) return;
    this.due = setTimeout(() => void this.sendNow(), Math.max(0, this.sent + period - performance.now()));
  }

  private async sendNow(): Promise<void> {
    const { wanted } = this;
    this.due = undefined;
    if (!wanted) return;
    this.sent = performance.now();
    await this.send(wanted, true);
    if (this.wanted === wanted) this.wanted = undefined; // the settings of the server have it, unless it was refused
  }
}
