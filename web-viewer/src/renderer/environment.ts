import { Face } from "../gen/spherule/v1/scene_pb";
import { niceAbove } from "../colour/range";
import { hexToRgb } from "../colour/rgb";
import { isWall } from "../model/facts";
import type { Facts, Vec3 } from "../model/facts";
import { Mesh } from "./mesh";
import { surfaceOf } from "./obstacles";
import type { Surface } from "./obstacles";
import { faces, polygon, vertexFloats } from "./shapes";
import type { Vertices } from "./shapes";
import type { Theme } from "./theme";

/** The static geometry around the spheres: floor, walls, edges of the bounds, obstacles. */
export class Environment {
  readonly solids: Mesh; // obstacles that are seen from outside alone
  readonly facing: Mesh; // the parts of other obstacles whose free side faces the eye
  readonly veils: Mesh; // translucent: far walls, and the parts of obstacles that are seen from behind
  readonly floor: Mesh;
  readonly edges: Mesh; // lines
  ruler = 1; // m between the lines on the floor
  fade = 1; // m around the bounds over which the floor fades out
  private facts: Facts | undefined;
  private theme: Theme | undefined;
  private oneSided: Surface[] = [];
  private eye: Vec3 | undefined; // for which the meshes are built

  constructor(gl: WebGL2RenderingContext) {
    this.solids = new Mesh(gl);
    this.facing = new Mesh(gl);
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
    this.floor.set(isWall(facts, Face.Z_MIN) ? polygon(corners, [0, 0, 1], [1, 1, 1, 1]) : [], facts.origin);
    const plain = hexToRgb(theme.solid) ?? [0.6, 0.6, 0.6];
    const surfaces = facts.obstacles.map((obstacle) => surfaceOf(obstacle, [...(obstacle.colour ?? plain), 1], facts));
    this.solids.set(surfaces.flatMap(({ vertices, oneSided }) => (oneSided ? [] : vertices)), facts.origin);
    this.oneSided = surfaces.filter(({ oneSided }) => oneSided);
    this.build(undefined);
  }

  /** Builds the meshes that depend on the eye's position: which surfaces face it. */
  face(eye: Vec3): void {
    if (this.eye?.every((value, axis) => value === eye[axis])) return;
    this.build(eye);
  }

  private build(eye: Vec3 | undefined): void {
    this.eye = eye && [...eye];
    const { facts, theme } = this;
    if (!facts || !theme) return;
    const facing: Vertices = [];
    const veils: Vertices = [];
    const wall = hexToRgb(theme.wall) ?? [0.7, 0.8, 0.8];
    for (const { vertices } of this.oneSided) {
      for (let from = 0; from < vertices.length; from += 3 * vertexFloats) {
        const triangle = vertices.slice(from, from + 3 * vertexFloats);
        if (!eye || isBefore(triangle, eye)) facing.push(...triangle);
        else veils.push(...triangle.map((value, i) => (i % vertexFloats === alphaAt ? 0.25 : value)));
      }
    }
    const lines: Vertices = [];
    const lift = 1e-3 * (facts.max[2] - facts.min[2]); // keeps lines above the floor
    const ink = hexToRgb(theme.ink) ?? [0, 0, 0];
    faces(facts.min, facts.max).forEach(({ normal, points }, index) => {
      const face = index + 1; // faces are listed in the order of the enum
      const [first] = points;
      const away = !eye || !first || dot(normal, eye) < dot(normal, first);
      const closed = isWall(facts, face as Face);
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
    this.facing.set(facing, facts.origin);
    this.veils.set(veils, facts.origin);
    this.edges.set(lines, facts.origin);
  }
}

const alphaAt = vertexFloats - 1;

/** True if the eye is on the side of the triangle to which its normals point. */
function isBefore(triangle: Vertices, eye: Vec3): boolean {
  const sum = (at: number): number =>
    (triangle[at] ?? 0) + (triangle[at + vertexFloats] ?? 0) + (triangle[at + 2 * vertexFloats] ?? 0);
  const normal: Vec3 = [sum(3), sum(4), sum(5)];
  return dot(normal, eye) > dot(normal, [sum(0) / 3, sum(1) / 3, sum(2) / 3]);
}

function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
