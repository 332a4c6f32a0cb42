/** The quantities that colour can show, with their numbers in renderer/shaders/colour.glsl. */
export const modes = { speed: 0, radius: 1, id: 2, cell: 3, group: 4 } as const;
export type Mode = keyof typeof modes;

export const modeNames: Record<Mode, string> = {
  speed: "Speed",
  radius: "Radius",
  id: "Id",
  cell: "Grid cell",
  group: "Group",
};

/** The default mode of a scene: "group" if at least two of its groups have a colour of their own, else "speed". */
export function modeFor(groups: readonly { own: boolean }[]): Mode {
  return groups.filter((group) => group.own).length > 1 ? "group" : "speed";
}

export const modeList = Object.keys(modes) as Mode[];
