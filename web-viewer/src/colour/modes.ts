/** What a sphere's colour says. The numbers are those of renderer/shaders/colour.glsl. */
export const modes = { speed: 0, radius: 1, id: 2, cell: 3, group: 4 } as const;
export type Mode = keyof typeof modes;

export const modeNames: Record<Mode, string> = {
  speed: "Speed",
  radius: "Radius",
  id: "Id",
  cell: "Grid cell",
  group: "Group",
};

/** What a scene is coloured by while nobody has chosen: its groups where it tells them apart by colour, else speed. */
export function modeFor(groups: readonly { own: boolean }[]): Mode {
  return groups.filter((group) => group.own).length > 1 ? "group" : "speed";
}

export const modeList = Object.keys(modes) as Mode[];
