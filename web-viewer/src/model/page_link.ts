import type { Vec3 } from "./facts";
import { modes } from "./quantities";
import type { Mode } from "./quantities";

/** A view of a scene that a link restores. It has nothing secret. Undefined parts are left as they are. */
export interface PageLink {
  scene?: string; // name
  camera?: { eye: Vec3; target: Vec3 }; // m
  colour?: Mode;
  sphere?: number; // id of the selected sphere
}

const farthest = 1e9; // m

/** The fragment of an address that holds the link, with its "#". */
export function fragmentOf({ scene, camera, colour, sphere }: PageLink): string {
  const parts: [string, string][] = [];
  if (scene) parts.push(["scene", scene]);
  if (camera) parts.push(["camera", [...camera.eye, ...camera.target].map(short).join(",")]);
  if (colour) parts.push(["colour", colour]);
  if (sphere !== undefined) parts.push(["sphere", String(sphere)]);
  return `#${parts.map(([name, value]) => `${name}=${encodeURIComponent(value).replaceAll("%2C", ",")}`).join("&")}`;
}

/** Reads the fragment of an address. `faults`: one sentence for each part that is ignored, for the user. */
export function linkIn(fragment: string): { link: PageLink; faults: string[] } {
  const link: PageLink = {};
  const faults: string[] = [];
  for (const [name, value] of new URLSearchParams(fragment.replace(/^#/, ""))) {
    const fault = readPart(link, name, value);
    if (fault) faults.push(fault);
  }
  return { link, faults };
}

/** Returns what is wrong with the part; empty if it was read. */
function readPart(link: PageLink, name: string, value: string): string {
  switch (name) {
    case "scene":
      link.scene = value;
      return value ? "" : "The scene has no name.";
    case "camera":
      link.camera = cameraOf(value);
      return link.camera ? "" : "The camera must be six numbers: the eye, then the target, at different points.";
    case "colour":
      link.colour = modes.find((mode) => mode === value);
      return link.colour ? "" : `There is no colour mode “${cut(value)}”. There are ${modes.join(", ")}.`;
    case "sphere":
      link.sphere = /^\d{1,15}$/.test(value) ? Number(value) : undefined;
      return link.sphere === undefined ? `“${cut(value)}” is not the number of a sphere.` : "";
    default:
      return `Links have no part “${cut(name)}”.`;
  }
}

function cameraOf(value: string): PageLink["camera"] {
  const numbers = value.split(",").map((part) => (part.trim() ? Number(part) : NaN));
  const [x = 0, y = 0, z = 0, u = 0, v = 0, w = 0] = numbers;
  const valid = numbers.length === 6 && numbers.every((number) => Math.abs(number) <= farthest);
  return valid && Math.hypot(x - u, y - v, z - w) > 0 ? { eye: [x, y, z], target: [u, v, w] } : undefined;
}

/** Six significant digits. */
function short(value: number): string {
  return String(Number(value.toPrecision(6)));
}

function cut(text: string): string {
  return text.length > 40 ? `${text.slice(0, 40)}…` : text;
}
