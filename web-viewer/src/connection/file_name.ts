const longestName = 40;

/** A name for a file, like those that the server gives to recordings: the scene and the time (UTC). */
export function fileNameOf(scene: string, ending: string, time = new Date()): string {
  const name = scene.replace(/[^A-Za-z0-9_-]/g, "").slice(0, longestName) || "scene";
  const digits = time.toISOString().replace(/\..*$/, "").replace(/[-:]/g, "");
  return `${name}-${digits.replace("T", "-")}${ending}`;
}
