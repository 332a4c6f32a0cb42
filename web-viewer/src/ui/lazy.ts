import type { Camera } from "../camera/camera";
import type { Ray } from "../camera/ray";
import type { View } from "../camera/view";
import type { Commands } from "../connection/commands";
import type { Selection } from "../model/selection";
import type { Session } from "../model/session";
import type { Shown } from "../model/states";
import type { Choices, Panel } from "./panel";
import type { Toasts } from "./toasts";

/** The page, for the parts that are loaded later. */
export interface Stage {
  container: HTMLElement;
  session: Session;
  commands: Commands;
  choices: Choices;
  camera: Camera;
  panel: Panel;
  selection: Selection;
  toasts: Toasts;
  blocked(): boolean; // whether this page may not send commands; it then tells the user
}

/** The tools that act on a place of the picture, besides select and push. Places in the picture are in CSS pixels. */
export interface Tools {
  /** A drag begins at the sphere at `place`. Returns true if it pulls the sphere. */
  grab(x: number, y: number, place: number | undefined): boolean;
  drag(x: number, y: number): void;
  /** Moves the point to which the selected sphere is pulled, by steps in the picture. False if there is none. */
  move(across: number, up: number, away: number): boolean;
  /** Returns false if no sphere was pulled. */
  letGo(): boolean;
  /** Drops spheres above the place that the picture shows on a ray. `place`: of the sphere there. */
  drop(ray: Ray, place: number | undefined): void;
  /** Call at every tick. */
  update(view: View, shown: Shown | undefined): void;
}

/** A dialog in which a scene file is read, changed and loaded. */
export interface Editor {
  readonly shown: boolean;
  /** `text`: of a file. It is loaded at once, and shown only if there is something wrong with it. */
  open(text?: string): Promise<void>;
}

type Part = "tools" | "editor";

/** The parts of the page that are not loaded with it: the tools after the first image, the editor when it opens. */
export class Lazy {
  tools: Tools | undefined; // undefined: not loaded yet
  private editor: Editor | undefined;
  private asked = false;

  constructor(private readonly stage: Stage) {}

  /** Whether the editor is open. */
  get editing(): boolean {
    return this.editor?.shown ?? false;
  }

  loadTools(): void {
    if (this.asked) return;
    this.asked = true;
    void this.load<{ Tools: new (stage: Stage) => Tools }>("tools").then((part) => {
      if (part) this.tools = new part.Tools(this.stage);
    });
  }

  /** `text`: of a scene file, which is then loaded. */
  async editScene(text?: Promise<string>): Promise<void> {
    const part = this.editor ? undefined : await this.load<{ Editor: new (stage: Stage) => Editor }>("editor");
    if (part) this.editor ??= new part.Editor(this.stage);
    await this.editor?.open(await text);
  }

  private async load<T>(part: Part): Promise<T | undefined> {
    try {
      const path = `./${part}.js`; // a bundle of its own
      return (await import(path)) as T;
    } catch {
      const text = "The server did not send a part of this page. Reload the page.";
      this.stage.toasts.show("Not loaded", text, "bad");
      return undefined;
    }
  }
}
