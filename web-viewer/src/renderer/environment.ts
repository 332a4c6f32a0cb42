import { Face } from "../gen/spherule/v1/scene_pb";
import { niceAbove } from "../colour/range";
import { hexToRgb } from "../colour/rgb";
import { isWall } from "../model/facts";
import type { Facts, Obstacle, Vec3 } from "../model/facts";
import type { Shown } from "../model/states";
import { Mesh } from "./mesh";
import { MovingObstacles } from "./moving_obstacles";
import type { Bounds } from "./moving_obstacles";
import { surfaceOf } from "./obstacles";
import type { Surface } from "./obstacles";
import type { Program } from "./program";
import { faces, polygon } from "./shapes";
import type { Vertices } from "./shapes";
import type { Theme } from "./theme";

const wallOpacity = 0.2;

/** The geometry around the spheres: floor, walls, edges of the bounds, obstacles. */
export class Environment {
  readonly walls: Mesh; // of the bounds: translucent from inside, invisible from outside
  readonly floor: Mesh;
  readonly edges: Mesh; // lines
  private readonly solids: Mesh; // obstacles at rest that are seen from outside alone
  private readonly oneSided: Mesh; // other obstacles at rest
  private readonly moving: MovingObstacles;
  ruler = 1; // m between the lines on the floor
  fade = 1; // m around the bounds over which the floor fades out

  constructor(gl: WebGL2RenderingContext) {
    this.solids = new Mesh(gl);
    this.oneSided = new Mesh(gl);
    this.moving = new MovingObstacles(gl);
    this.walls = new Mesh(gl);
    this.floor = new Mesh(gl);
    this.edges = new Mesh(gl);
  }

  set(facts: Facts, theme: Theme): void {
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
    const look = (obstacle: Obstacle, bounds: Bounds): Surface =>
      surfaceOf(obstacle, [...(obstacle.colour ?? plain), 1], bounds);
    const surfaces = facts.obstacles.flatMap((obstacle) => (obstacle.pivot ? [] : look(obstacle, facts)));
    const verticesOf = (oneSided: boolean): Vertices =>
      surfaces.flatMap((surface) => (surface.oneSided === oneSided ? surface.vertices : []));
    this.solids.set(verticesOf(false), facts.origin);
    this.oneSided.set(verticesOf(true), facts.origin);
    this.moving.set(facts, look);
    const wall = [...(hexToRgb(theme.wall) ?? [0.7, 0.8, 0.8]), wallOpacity];
    const walls = faces(min, max).flatMap(({ normal, points }, index) => {
      const face = (index + 1) as Face; // faces are listed in the order of the enum
      const inward: Vec3 = [-normal[0], -normal[1], -normal[2]];
      return face !== Face.Z_MIN && isWall(facts, face) ? polygon([...points].reverse(), inward, wall) : [];
    });
    this.walls.set(walls, facts.origin);
    this.buildEdges(facts, theme);
  }

  /** Moves obstacles to where they are between two states. */
  place(shown: Shown, { origin }: Facts): void {
    this.moving.place(shown, origin);
  }

  /**
   * Draws obstacles with a program of shaders/solid.vert.glsl. `oneSided`: those that are opaque from the free side and
   * translucent from behind; else those that are seen from outside alone.
   */
  drawObstacles(used: Program, oneSided: boolean): void {
    (oneSided ? this.oneSided : this.solids).draw();
    this.moving.draw(used, oneSided);
  }

  private buildEdges(facts: Facts, theme: Theme): void {
    const lines: Vertices = [];
    const lift = 1e-3 * (facts.max[2] - facts.min[2]); // keeps lines above the floor
    const ink = hexToRgb(theme.ink) ?? [0, 0, 0];
    faces(facts.min, facts.max).forEach(({ normal, points }, index) => {
      const strength = isWall(facts, index + 1) ? 1 : 0.6;
      const lifted = points.map(([x, y, z]): Vec3 => [x, y, Math.max(z, facts.min[2] + lift)]);
      lifted.forEach((point, i) => {
        const next = lifted[(i + 1) % lifted.length] ?? point;
        lines.push(...point, ...normal, ...ink, strength, ...next, ...normal, ...ink, strength);
      });
    });
    this.edges.set(lines, facts.origin);
  }
}
