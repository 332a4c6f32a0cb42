import { rayThrough } from "../camera/ray";
import type { Ray } from "../camera/ray";
import type { View } from "../camera/view";
import { positionOf, shownPosition } from "../model/positions";
import type { Shown } from "../model/states";
import type { Tools as LazyTools, Stage } from "../ui/lazy";
import { adoptStyle } from "../ui/parts";
import { dropAbove, placeOnRay } from "./drop_place";
import { GravityArrow } from "./gravity_arrow";
import { acrossPlane, moved } from "./plane";
import { Pull } from "./pull";
import { PullLine } from "./pull_line";
import style from "./tools.css";

export { RangeEntry } from "./range_entry"; // for ui/legend.ts

const keySteps = 40; // of the picture's height, per press of a key

/** See ui/lazy.ts. */
export class Tools implements LazyTools {
  private readonly pull: Pull;
  private readonly line: PullLine;
  private readonly arrow: GravityArrow;

  constructor(private readonly stage: Stage) {
    adoptStyle(style);
    const { commands, container, panel, camera } = stage;
    this.pull = new Pull(
      (sphere, point) => commands.pull(sphere, point),
      () => void commands.release(),
    );
    this.line = new PullLine(container);
    this.arrow = new GravityArrow(
      (gravity, quiet) => commands.set("Gravity", { gravity: [...gravity] }, quiet),
      () => stage.blocked(),
      () => camera.last,
    );
    panel.arrowRoom.append(this.arrow.element);
  }

  grab(x: number, y: number, place: number | undefined): boolean {
    const { choices, session, camera } = this.stage;
    const { facts, newest } = session;
    if (choices.tool !== "pull" || place === undefined || !facts || !newest || session.replay) return false;
    const id = facts.population.idOf(place);
    if (id === undefined || this.stage.blocked()) return false;
    const at = positionOf(facts, newest, place);
    this.pull.grab(id, at, acrossPlane(camera.last, rayThrough(camera.last, x, y), at) ?? at);
    return true;
  }

  /** The point follows the pointer, in the plane parallel to the picture through the place of the grab. */
  drag(x: number, y: number): void {
    const { camera } = this.stage;
    const { plane } = this.pull;
    const point = plane && acrossPlane(camera.last, rayThrough(camera.last, x, y), plane);
    if (point) this.pull.drag(point);
  }

  move(across: number, up: number, away: number): boolean {
    const { choices, session, selection, camera } = this.stage;
    const { facts, newest } = session;
    const { id, place } = selection;
    if (choices.tool !== "pull" || id === undefined || place === undefined || !facts || !newest) return false;
    if (session.replay || this.stage.blocked()) return true;
    if (this.pull.sphere !== id) {
      const at = positionOf(facts, newest, place);
      this.pull.grab(id, at, at);
    }
    const view = camera.last;
    const step = (2 * view.halfTangent * view.distance) / keySteps;
    this.pull.drag(moved(view, this.pull.point, [across * step, up * step, away * step]));
    return true;
  }

  letGo(): boolean {
    return this.pull.letGo();
  }

  drop(ray: Ray, place: number | undefined): void {
    const { session, panel } = this.stage;
    const { facts, newest, settings } = session;
    if (!facts || !newest) return;
    const sphere = place === undefined ? undefined : positionOf(facts, newest, place);
    const at = sphere ?? placeOnRay(facts, ray, newest);
    const clear = place === undefined ? 0 : facts.population.radiusOf(place);
    void panel.dropSpheres((_, count, radius) => dropAbove(facts, settings?.gravity, at, clear, count, radius));
  }

  refresh(view: View, blockedReason: string): void {
    this.arrow.update(view, this.stage.session.settings?.gravity, blockedReason);
  }

  update(view: View, shown: Shown | undefined): void {
    const { facts } = this.stage.session;
    const { sphere, point, force } = this.pull;
    const place = sphere === undefined ? undefined : facts?.population.placeOf(sphere);
    if (sphere !== undefined && (place === undefined || this.stage.choices.tool !== "pull")) this.pull.letGo();
    if (place === undefined || !facts || !shown || place >= shown.to.count) return this.line.hide();
    this.line.show(view, shownPosition(facts, shown, place), point, force);
  }
}
