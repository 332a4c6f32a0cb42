import { Face } from "../gen/spherule/v1/scene_pb";
import { niceAbove } from "../colour/range";
import { hexToRgb } from "../colour/rgb";
import type { Rgb } from "../colour/rgb";
import type { Facts, Vec3 } from "../model/facts";
import { Mesh } from "./mesh";
import { boxSurface, faces, planeInBox, polygon } from "./shapes";
import type { Vertices } from "./shapes";
import type { Theme } from "./theme";

/** The static geometry around the spheres: floor, walls, edges of the bounds, obstacles. */
export class Environment {
  readonly solids: Mesh; // boxes, and planes whose free side faces the eye
  readonly veils: Mesh; // translucent: far walls, and planes seen from behind
  readonly floor: Mesh;
  readonly edges: Mesh; // lines
  ruler = 1; // m between the lines on the floor
  fade = 1; // m around the bounds over which the floor fades out
  private facts: Facts | undefined;
  private theme: Theme | undefined;

  constructor(gl: WebGL2RenderingContext) {
    this.solids = new Mesh(gl);
    this.veils = new Mesh(gl);
    this.floor = new Mesh(gl);
    this.edges = new Mesh(gl);
  }

  set(facts: Facts, theme: Theme): void {
    this.facts = facts;
    this.theme = theme;
    const { min, max } = facts;
    const wide = Math.max(max[0] - min[0], max[1] - min[1]);
    this.ruler = niceAbove(wide / 12);
    this.fade = 1.1 * wide;
    const reach = this.fade;
    const corners: Vec3[] = [
      [min[0] - reach, min[1] - reach, min[2]],
      [max[0] + reach, min[1] - reach, min[2]],
      [max[0] + reach, max[1] + reach, min[2]],
      [min[0] - reach, max[1] + reach, min[2]],
    ];
    this.floor.set(facts.open.has(Face.Z_MIN) ? [] : polygon(corners, [0, 0, 1], [1, 1, 1, 1]));
    this.face(undefined);
  }

  /** Builds the meshes that depend on the eye's position: which surfaces face it. */
  face(eye: Vec3 | undefined): void {
    const { facts, theme } = this;
    if (!facts || !theme) return;
    const solids: Vertices = [];
    const veils: Vertices = [];
    const wall = hexToRgb(theme.wall) ?? [0.7, 0.8, 0.8];
    const plain = hexToRgb(theme.solid) ?? [0.6, 0.6, 0.6];
    const opaque = (rgb: Rgb | undefined, alpha = 1): number[] => [...(rgb ?? plain), alpha];
    for (const box of facts.boxes) solids.push(...boxSurface(box, opaque(box.colour)));
    for (const plane of facts.planes) {
      const points = planeInBox(plane, facts.min, facts.max);
      const free = !eye || dot(plane.normal, eye) > dot(plane.normal, plane.point);
      if (free) solids.push(...polygon(points, plane.normal, opaque(plane.colour)));
      else veils.push(...polygon(points, plane.normal, opaque(plane.colour, 0.25)));
    }
    const lines: Vertices = [];
    const lift = 1e-3 * (facts.max[2] - facts.min[2]); // keeps lines above the floor
    const ink = hexToRgb(theme.ink) ?? [0, 0, 0];
    faces(facts.min, facts.max).forEach(({ normal, points }, index) => {
      const face = index + 1; // faces are listed in the order of the enum
      const [first] = points;
      const away = !eye || !first || dot(normal, eye) < dot(normal, first);
      const closed = !facts.open.has(face as Face);
      if (closed && away && face !== Face.Z_MIN) {
        veils.push(...polygon(points, [-normal[0], -normal[1], -normal[2]], [...wall, 0.2]));
      }
      const strength = (away ? 0.3 : 0.12) * (closed ? 1 : 0.6);
      const lifted = points.map(([x, y, z]): Vec3 => [x, y, Math.max(z, facts.min[2] + lift)]);
      lifted.forEach((point, i) => {
        const next = lifted[(i + 1) % lifted.length] ?? point;
        lines.push(...point, ...normal, ...ink, strength, ...next, ...normal, ...ink, strength);
      });
    });
    this.solids.set(solids);
    this.veils.set(veils);
    this.edges.set(lines);
  }
}

function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
