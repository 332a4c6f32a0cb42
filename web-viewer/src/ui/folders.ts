import type GUI from "lil-gui";

const key = "spherule.folders";

type Store = Pick<Storage, "getItem" | "setItem">;

/**
 * Opens the folders of the panel, except the `folded` ones. A folder that the user has opened or closed stays as it is
 * when the page is loaded again, if the browser can store it. Folders open and close at once: if lil-gui's animation is
 * interrupted, for example because the panel is hidden, the content stays cut off.
 */
export function rememberFolders(gui: GUI, folded: GUI[], store: () => Store): void {
  for (const folder of gui.foldersRecursive()) folder.openAnimated = (open) => folder.open(open);
  const chosen = load(store); // by title: whether it is open
  for (const folder of gui.folders) folder.open(chosen[folder._title] ?? !folded.includes(folder));
  gui.onOpenClose((folder) => {
    chosen[folder._title] = !folder._closed;
    try {
      store().setItem(key, JSON.stringify(chosen));
    } catch {
      // The browser forbids storage: the next page starts with the default.
    }
  });
}

function load(store: () => Store): Record<string, boolean> {
  try {
    const saved: unknown = JSON.parse(store().getItem(key) ?? "{}");
    return Object.fromEntries(Object.entries(saved ?? {}).filter(([, open]) => typeof open === "boolean"));
  } catch {
    return {};
  }
}
