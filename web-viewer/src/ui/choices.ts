import type { ViewRequest } from "../connection/messages";
import { observed } from "../observed";
import type { RenderQualityChoice } from "../renderer/render_quality";
import type { ThemeName } from "../renderer/theme";
import { Cut } from "../model/cut";
import type { Mode } from "../model/quantities";

/** The effect of a click or a drag on the picture. */
export type ToolName = "select" | "push" | "pull" | "drop";

/** When spheres have a pattern that turns with them. */
export type RotationChoice = "auto" | "shown" | "hidden";

/** The first values of choices that an address or the browser can give. */
export interface FirstChoices {
  mode: Mode | undefined; // undefined: the scene determines it
  theme: ThemeName | undefined; // undefined: the system determines it
  quality: RenderQualityChoice;
  view: ViewRequest;
}

/** Choices of the user that concern only this page. */
export class Choices {
  @observed accessor mode: Mode;
  modeChosen: boolean; // false: the scene determines the mode
  @observed accessor theme: ThemeName;
  themeChosen: boolean; // false: the system determines the theme
  @observed accessor rotation: RotationChoice = "auto";
  @observed accessor quality: RenderQualityChoice;
  @observed accessor tool: ToolName = "select";
  @observed accessor impulse = 1; // N s, of a push
  @observed accessor dropCount = 200; // spheres
  @observed accessor dropRadius = 0.05; // m
  @observed accessor view: ViewRequest;
  @observed accessor trace = true; // the path of the selected sphere is shown
  @observed accessor pictureWidth = 3840; // px, of saved pictures
  @observed accessor pictureHeight = 2160; // px
  readonly cut = new Cut();

  /** `systemTheme`: of the browser. */
  constructor({ mode, theme, quality, view }: FirstChoices, systemTheme: ThemeName) {
    this.mode = mode ?? "speed";
    this.modeChosen = mode !== undefined;
    this.theme = theme ?? systemTheme;
    this.themeChosen = theme !== undefined;
    this.quality = quality;
    this.view = view;
  }

  chooseTheme(theme: ThemeName): void {
    this.theme = theme;
    this.themeChosen = true;
  }

  colourBy(mode: Mode): void {
    this.mode = mode;
    this.modeChosen = true;
  }
}
