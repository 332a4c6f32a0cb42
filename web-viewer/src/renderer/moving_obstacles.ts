import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Facts, Obstacle, Vec3 } from "../model/facts";
import { placed, turned } from "../model/placement";
import type { Placement } from "../model/placement";
import { writePose } from "../model/poses";
import type { Shown } from "../model/states";
import { Mesh } from "./mesh";
import type { Surface } from "./obstacles";
import type { Program } from "./program";

interface Body {
  obstacle: number;
  pivot: Vec3; // m
  normal: Vec3 | undefined; // of a plane, at the beginning
  mesh: Mesh; // relative to the pivot
  oneSided: boolean;
  now: Placement; // relative to the centre of the bounds
}

export type Bounds = Pick<Facts, "min" | "max">;

const none: Vec3 = [0, 0, 0];
const atRest: Placement = { turn: [0, 0, 0, 1], move: none };
const edge = 1.0001; // a plane in a face of the bounds is inside them

/** Obstacles that move. Each has vertices of its own, which the device moves to where the obstacle is. */
export class MovingObstacles {
  private bodies: Body[] = [];
  private readonly half: Vec3 = [0, 0, 0]; // m: half the bounds
  private readonly normal: Vec3 = [0, 0, 0];

  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** `look`: the surface of an obstacle, whose planes end at the bounds given. */
  set({ min, max, origin, obstacles }: Facts, look: (obstacle: Obstacle, bounds: Bounds) => Surface): void {
    for (const { mesh } of this.bodies) mesh.free();
    vec3.scale(this.half, vec3.subtract([0, 0, 0], max, origin), edge);
    this.bodies = obstacles.flatMap((one, obstacle) => {
      const { shape, placement, pivot } = one;
      if (!pivot) return [];
      const plane = shape.case === "plane" ? shape.value : undefined;
      // A plane is large enough to cross the bounds wherever it is.
      const reach = plane ? vec3.distance(min, max) + vec3.distance(placed(placement, plane.point as Vec3), pivot) : 0;
      const around = (side: number): Vec3 => pivot.map((x) => x + side * reach) as Vec3;
      const { vertices, oneSided } = look(one, { min: around(-1), max: around(1) });
      const mesh = new Mesh(this.gl);
      mesh.set(vertices, pivot);
      const normal = plane && (vec3.normalize([0, 0, 0], turned(placement, plane.normal as Vec3)) as Vec3);
      const now: Placement = { turn: [0, 0, 0, 1], move: vec3.subtract([0, 0, 0], pivot, origin) as Vec3 };
      return [{ obstacle, pivot, normal, mesh, oneSided, now }];
    });
  }

  /** Moves them to where they are between two states. */
  place(shown: Shown, origin: Vec3): void {
    // Iterators would allocate memory in each image.
    for (let k = 0; k < this.bodies.length; k++) {
      const body = this.bodies[k];
      if (!body) continue;
      const { obstacle, pivot, normal, now } = body;
      const { turn, move } = now;
      writePose(now, shown, obstacle, pivot);
      vec3.subtract(move, move, origin);
      if (!normal) continue;
      // A plane that moves along itself stays the same.
      vec3.transformQuat(this.normal, normal, turn);
      vec3.scale(move, this.normal, vec3.dot(this.normal, move));
    }
  }

  /** Draws with a program of shaders/solid.vert.glsl. */
  draw(used: Program, oneSided: boolean): void {
    for (let k = 0; k < this.bodies.length; k++) {
      const body = this.bodies[k];
      if (body?.oneSided !== oneSided) continue;
      this.setUniforms(used, body.now, body.normal ? this.half : none);
      body.mesh.draw();
    }
    this.setUniforms(used, atRest, none);
  }

  private setUniforms(used: Program, { turn, move }: Placement, half: Vec3): void {
    const { gl } = this;
    gl.uniform4f(used.at("u_turn"), turn[0], turn[1], turn[2], turn[3]);
    gl.uniform3f(used.at("u_move"), move[0], move[1], move[2]);
    gl.uniform3f(used.at("u_ends"), half[0], half[1], half[2]);
  }
}
