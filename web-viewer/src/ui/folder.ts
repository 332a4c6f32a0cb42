import { effect } from "@preact/signals-core";
import { observed } from "../observed";
import { live, liveText } from "./bindings";
import { Controls } from "./controls";
import { h } from "./dom";

type Store = Pick<Storage, "getItem" | "setItem">;

interface FolderOptions {
  title?: () => string; // instead of the name; follows state
  folded?: boolean; // at first
  hidden?: () => boolean;
  blocked?: () => string; // see Controls
}

/** A group of controls in the panel that the user can open and close. */
export class Folder extends Controls {
  @observed accessor open: boolean;
  readonly element: HTMLDetailsElement;

  /** `name`: for the user, and for style sheets. */
  constructor(
    readonly name: string,
    { title = (): string => name, folded = false, hidden = (): boolean => false, blocked }: FolderOptions = {},
  ) {
    super(blocked);
    this.open = !folded;
    const heading = h("summary", {}, liveText(title));
    const element = h("details", { class: "folder", "data-folder": name }, heading, this.body);
    this.element = live(element, { open: () => this.open, hidden });
    element.addEventListener("toggle", () => (this.open = element.open));
  }
}

const key = "spherule.folders";

/**
 * Folders stay open or closed as the user has left them when the page is loaded again, if the browser can store it.
 */
export function rememberFolders(folders: Folder[], store: () => Store): void {
  const chosen = load(store); // by name: whether it is open
  for (const folder of folders) {
    const first = chosen[folder.name] ?? folder.open;
    folder.open = first;
    let before = first;
    effect(() => {
      const { open } = folder;
      if (open === before) return;
      before = open;
      chosen[folder.name] = open;
      try {
        store().setItem(key, JSON.stringify(chosen));
      } catch {
        // The browser forbids storage: the next page starts with the default.
      }
    });
  }
}

function load(store: () => Store): Record<string, boolean> {
  try {
    const saved: unknown = JSON.parse(store().getItem(key) ?? "{}");
    return Object.fromEntries(Object.entries(saved ?? {}).filter(([, open]) => typeof open === "boolean"));
  } catch {
    return {};
  }
}
