import { hexToRgb } from "../colour/rgb";

/** Colours of environment and light. The colours of the page's elements are in ui/style/theme.css. */
export interface Theme {
  backgroundTop: string;
  backgroundBottom: string;
  tile: string;
  surround: string;
  ink: string;
  wall: string;
  solid: string; // obstacles to which the scene gives no colour
  key: number[]; // linear light
  sky: number[];
  ground: number[];
  shadow: number; // strength
  haze: number; // grey over a stale image, 0..1
}

export const themes = {
  light: {
    backgroundTop: "#e9edf0",
    backgroundBottom: "#d3dadf",
    tile: "#d9dee1",
    surround: "#cdd4d9",
    ink: "#5d6f7d",
    wall: "#b9c9d4",
    solid: "#a8b4bd",
    key: [0.86, 0.82, 0.75],
    sky: [0.42, 0.46, 0.52],
    ground: [0.2, 0.19, 0.185],
    shadow: 0.86,
    haze: 0.9,
  },
  dark: {
    backgroundTop: "#2a3239",
    backgroundBottom: "#171c21",
    tile: "#36414a",
    surround: "#242c33",
    ink: "#93a7b5",
    wall: "#6f8796",
    solid: "#66757f",
    key: [0.86, 0.83, 0.77],
    sky: [0.27, 0.31, 0.37],
    ground: [0.11, 0.11, 0.12],
    shadow: 0.9,
    haze: 0.1,
  },
} satisfies Record<string, Theme>;

export type ThemeName = keyof typeof themes;

/** Converts "#rrggbb" to linear light, with the gamma of shaders/light.glsl. */
export function linear(hex: string): [number, number, number] {
  const [r, g, b] = hexToRgb(hex) ?? [0, 0, 0];
  return [r * r, g * g, b * b];
}
