import type { Vec3 } from "../scene/facts";

/** m/s². */
export const presets: Record<string, Vec3> = {
  Earth: [0, 0, -9.81],
  Moon: [0, 0, -1.62],
  Zero: [0, 0, 0],
  Sideways: [6.94, 0, -6.94], // of the Earth's strength
};

export function presetOf(gravity: Vec3): string {
  const same = (preset: Vec3): boolean => preset.every((part, axis) => Math.abs(part - (gravity[axis] ?? 0)) < 5e-3);
  return Object.keys(presets).find((name) => same(presets[name] ?? [0, 0, 0])) ?? "Own";
}
