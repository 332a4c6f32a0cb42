import type { Toasts } from "./toasts";

/** The bundles that the page loads when it needs them; tools/build.mjs makes them. */
export type PartName = "charts" | "editor" | "gallery" | "scene_parts" | "statistics" | "tools";

export type LoadPart = <T>(name: PartName) => Promise<T | undefined>;

/** Loads a bundle. If the server does not send it, notifies the user and returns undefined. */
export async function loadPart<T>(name: PartName, toasts: Toasts): Promise<T | undefined> {
  try {
    const path = `./${name}.js`;
    return (await import(path)) as T;
  } catch {
    const text = "The server did not send a part of this page. Try again, or reload the page.";
    toasts.show("Not loaded", text, "bad");
    return undefined;
  }
}

const adopted = new Set<string>();

/** Adds a style sheet to the page, once. */
export function adoptStyle(style: string): void {
  if (adopted.has(style)) return;
  adopted.add(style);
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(style);
  document.adoptedStyleSheets.push(sheet);
}
