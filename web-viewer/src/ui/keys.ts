import type { Camera } from "../camera/camera";
import { modes, quantityOf } from "../model/quantities";
import type { Mode } from "../model/quantities";
import { concerns } from "./hosts";

export interface Key {
  keys: string[]; // as KeyboardEvent.key, letters in lower case
  shown: string; // name in the help; empty: not listed
  description: string;
  act(): void;
}

/** Keys that move a focused slider, and that scroll a dialog. */
const sliderKeys = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp", "PageDown"];

type Store = Pick<Storage, "getItem" | "setItem">;

/**
 * Whether keys of one character act, such as "r" or "+". The user can switch them off, because software for speech
 * input types them by mistake (WCAG 2.2, 2.1.4). The browser remembers it.
 */
export class CharacterKeys {
  private static readonly key = "spherule.characterKeys";
  private on: boolean;

  constructor(private readonly store: () => Store) {
    this.on = this.saved() !== "off";
  }

  get enabled(): boolean {
    return this.on;
  }

  set enabled(on: boolean) {
    this.on = on;
    try {
      this.store().setItem(CharacterKeys.key, on ? "on" : "off");
    } catch {
      // The browser forbids storage: the next page starts with the default.
    }
  }

  private saved(): string | null {
    try {
      return this.store().getItem(CharacterKeys.key);
    } catch {
      return null;
    }
  }
}

/** Listens for keys of the viewer in `host`, except while the focused element handles them. */
export function listenForKeys(host: HTMLElement, keys: () => Key[], characters: CharacterKeys): void {
  const pressedDown = (event: KeyboardEvent): void => {
    if (!concerns(host, event)) return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof HTMLElement && handlesKey(event.target, event.key)) return;
    if (event.key.length === 1 && event.key !== " " && !characters.enabled) return;
    const pressed = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const key = keys().find((candidate) => candidate.keys.includes(pressed));
    if (!key) return;
    event.preventDefault(); // arrows and space would scroll
    key.act();
  };
  window.addEventListener("keydown", pressedDown, true); // captures: the panel stops the propagation of keys
}

/** Whether the focused element handles the key itself. */
function handlesKey(target: HTMLElement, key: string): boolean {
  if (target.matches("button, summary, input[type=checkbox]")) return key === " " || key === "Enter";
  if (target.matches("input[type=range], dialog")) return sliderKeys.includes(key);
  if (key === "Escape") return target.matches("input[data-edited]");
  return target.matches("input, select, textarea");
}

export interface KeyActions {
  toggle(): void;
  step(count: number): void;
  reset(): void;
  panel(): void;
  colour(mode: Mode): void;
  push(): void;
  lock(): void;
  drop(): void;
  remove(): void;
  help(): void;
  deselect(): void;
  home(): void;
  follow(): void;
  present(): void;
  middle(): void; // clicks in the middle of the picture
  /** Moves the pulled sphere, in steps in the picture; returns false if there is none. */
  move(across: number, up: number, away: number): boolean;
  camera: Camera;
}

const nudge = 40; // px of the drag that corresponds to one press of an arrow key

/** The keys of the page. `playing`: the server plays a recording. The help shows the same list. */
export function keysFor(actions: KeyActions, playing: boolean): Key[] {
  const { camera } = actions;
  const colours = Object.fromEntries(modes.map((mode, i) => [String((i + 1) % 10), mode]));
  const colourNames = modes.map((mode) => quantityOf(mode).label.toLowerCase()).join(", ");
  const arrows: Record<string, [number, number]> = {
    ArrowLeft: [nudge, 0],
    ArrowRight: [-nudge, 0],
    ArrowUp: [0, nudge],
    ArrowDown: [0, -nudge],
  };
  const one = (key: string, description: string, action: () => void, shown = key.toUpperCase()): Key => ({
    keys: [key],
    shown,
    description,
    act: action,
  });
  const each = <T>(shown: string, description: string, table: Record<string, T>, action: (value: T) => void): Key[] =>
    Object.entries(table).map(([key, value], index) => ({
      keys: [key],
      shown: index === 0 ? shown : "",
      description,
      act: () => action(value),
    }));
  const simulated = [
    one("d", "drop spheres", actions.drop),
    one("p", "push mode", actions.push),
    one("Delete", "remove the selected sphere", actions.remove, "Del"),
    ...each("PgUp  PgDn", "move the pulled sphere away, nearer", { PageUp: 1, PageDown: -1 }, (away) => {
      actions.move(0, 0, away);
    }),
    one("End", "from the past back to live", actions.present, "End"),
  ];
  return [
    one(" ", "pause, resume", actions.toggle, "Space"),
    one(".", playing ? "one frame" : "one step", () => actions.step(1)),
    one("r", playing ? "go to the beginning" : "reset the scene", actions.reset),
    ...(playing ? [] : simulated),
    ...each(`1 – ${modes.length % 10}`, `colour by ${colourNames}`, colours, actions.colour),
    one("l", "lock the colour range", actions.lock),
    one("f", "reset the view", actions.home),
    one("g", "follow the selected sphere", actions.follow),
    one("o", "perspective or orthographic view", () => (camera.orthographic = !camera.orthographic)),
    one("x", "look along x", () => camera.along(0, 0)),
    one("y", "look along y", () => camera.along(-Math.PI / 2, 0)),
    one("z", "look down", () => camera.along(-Math.PI / 2, Math.PI / 2 - 0.02)),
    ...each("Arrows", playing ? "orbit" : "orbit, or move the pulled sphere", arrows, ([dx, dy]) => {
      if (!actions.move(-dx / nudge, dy / nudge, 0)) camera.orbit(dx, dy);
    }),
    one("Enter", "click in the middle of the picture", actions.middle, "Enter"),
    ...each("+  −", "zoom", { "+": 0.8, "=": 0.8, "-": 1.25 }, (factor) => camera.zoom(factor)),
    one("c", "show or hide the controls", actions.panel),
    one("?", "this help", actions.help),
    one("Escape", "release, close, deselect", actions.deselect, "Esc"),
  ];
}
