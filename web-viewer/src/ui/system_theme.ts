import type { ThemeName } from "../renderer/theme";

const dark = window.matchMedia("(prefers-color-scheme: dark)");

/** The theme that the system prefers; with forced colours, the one that fits them. */
export function systemTheme(): ThemeName {
  return dark.matches ? "dark" : "light";
}

export function whenSystemThemeChanges(changed: (theme: ThemeName) => void): void {
  dark.addEventListener("change", () => changed(systemTheme()));
}
