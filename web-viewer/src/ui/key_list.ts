import type { Camera } from "../camera/camera";
import type { Key } from "./keys";

export interface KeyActions {
  toggle(): void;
  step(count: number): void;
  reset(): void;
  panel(): void;
  colour(index: number): void;
  push(): void;
  lock(): void;
  drop(): void;
  help(): void;
  forget(): void;
  camera: Camera;
}

const nudge = 40; // px of a drag that an arrow key stands for

/** Every key of the page that works while it plays a recording, or else simulates; the help shows the same list. */
export function keysFor(act: KeyActions, playing: boolean): Key[] {
  const { camera } = act;
  const colours = ["1", "2", "3", "4", "5"];
  const arrows: Record<string, [number, number]> = {
    ArrowLeft: [nudge, 0],
    ArrowRight: [-nudge, 0],
    ArrowUp: [0, nudge],
    ArrowDown: [0, -nudge],
  };
  const one = (key: string, says: string, action: () => void, shown = key.toUpperCase()): Key => ({
    keys: [key],
    shown,
    says,
    act: action,
  });
  const each = <T>(shown: string, says: string, table: Record<string, T>, action: (value: T) => void): Key[] =>
    Object.entries(table).map(([key, value], index) => ({
      keys: [key],
      shown: index === 0 ? shown : "",
      says,
      act: () => action(value),
    }));
  return [
    one(" ", "pause, resume", act.toggle, "Space"),
    one(".", playing ? "one frame" : "one step", () => act.step(1)),
    one("r", playing ? "to the beginning" : "reset the scene", act.reset),
    ...(playing ? [] : [one("d", "drop spheres", act.drop), one("p", "push mode", act.push)]),
    ...each("1 – 5", "colour by speed, radius, id, grid cell, group", Object.fromEntries(colours.map((key, i) => [key, i])), act.colour),
    one("l", "lock the range of colours", act.lock),
    one("f", "reset the view", () => camera.reset()),
    one("x", "look along x", () => camera.along(0, 0)),
    one("y", "look along y", () => camera.along(-Math.PI / 2, 0)),
    one("z", "look down", () => camera.along(-Math.PI / 2, Math.PI / 2 - 0.02)),
    ...each("Arrows", "orbit", arrows, ([dx, dy]) => camera.orbit(dx, dy)),
    ...each("+  −", "zoom", { "+": 0.8, "=": 0.8, "-": 1.25 }, (factor) => camera.zoom(factor)),
    one("c", "show or hide the controls", act.panel),
    one("?", "this help", act.help),
    one("Escape", "close, forget the selection", act.forget, "Esc"),
  ];
}
