import type { Camera } from "../camera/camera";
import type { Ray } from "../camera/ray";
import type { View } from "../camera/view";
import type { Commands } from "../connection/commands";
import type { Gallery } from "../gallery/gallery";
import type { Choices } from "./choices";
import type { Selection } from "../model/selection";
import type { Session } from "../model/session";
import type { Shown } from "../model/states";
import type { Panel } from "./panel";
import { loadPart } from "./parts";
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
  /** Updates the tools' elements in the panel. `blockedReason`: why the user may not use them; empty if they may. */
  refresh(view: View, blockedReason: string): void;
  /** Call at every tick. */
  update(view: View, shown: Shown | undefined): void;
}

/** A dialog in which a scene file is read, changed and loaded. */
export interface Editor {
  readonly shown: boolean;
  /** `text`: of a file. It is loaded at once, and shown only if there is something wrong with it. */
  open(text?: string): Promise<void>;
}

interface EditorPart {
  Editor: new (stage: Stage) => Editor;
}

interface GalleryPart {
  Gallery: new (session: Session, commands: Commands) => Gallery;
}

const interactions = ["pointermove", "pointerdown", "keydown", "focusin", "change"];

/** Parts of the page that it does not need at first: tools from the first interaction on, and dialogs. */
export class Lazy {
  tools: Tools | undefined; // undefined: not loaded yet
  gallery: Gallery | undefined;
  private editor: Editor | undefined;

  constructor(private readonly stage: Stage) {
    const first = (): void => {
      for (const name of interactions) window.removeEventListener(name, first, true);
      void this.loadTools().then(() => {
        if (!this.tools) listen(); // the next interaction tries again
      });
    };
    const listen = (): void => {
      for (const name of interactions) window.addEventListener(name, first, true);
    };
    listen();
  }

  /** Whether a dialog is open, which has keys of its own. */
  get dialog(): boolean {
    return (this.editor?.shown ?? false) || (this.gallery?.open ?? false);
  }

  /** `blockedReason`: why the user may not load a scene; empty if they may. */
  async showGallery(blockedReason: string): Promise<void> {
    const { session, commands, container, toasts } = this.stage;
    const part = this.gallery ? undefined : await loadPart<GalleryPart>("gallery", toasts);
    if (part && !this.gallery) {
      this.gallery = new part.Gallery(session, commands);
      container.append(this.gallery.element);
    }
    this.gallery?.show(blockedReason);
  }

  /** `text`: of a scene file, which is then loaded. */
  async editScene(text?: Promise<string>): Promise<void> {
    const part = this.editor ? undefined : await loadPart<EditorPart>("editor", this.stage.toasts);
    if (part) this.editor ??= new part.Editor(this.stage);
    await this.editor?.open(await text);
  }

  private async loadTools(): Promise<void> {
    const part = await loadPart<{ Tools: new (stage: Stage) => Tools }>("tools", this.stage.toasts);
    if (part) this.tools = new part.Tools(this.stage);
  }
}
