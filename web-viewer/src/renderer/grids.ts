import type { Positions } from "../columns";
import type { Vec3 } from "../model/facts";
import { unitsOf } from "../model/units";
import type { Program } from "./program";

/** How the whole numbers of both states become metres relative to the eye: see shaders/spheres.glsl. */
export class Grids {
  private readonly quanta = new Float32Array(6);
  private readonly rest = new Float32Array(6);
  private readonly turns = new Int32Array(6);
  private readonly eye = new Int32Array(6);

  /** `end`: 0 for the first state, 1 for the second one. `eye`: relative to the centre of the bounds (m). */
  set(end: 0 | 1, { quanta, turns }: Positions, eye: Vec3): void {
    // Runs for every image: an iterator would be new memory each time.
    for (let k = 0; k < 3; k++) {
      const axis = k as 0 | 1 | 2;
      const at = 3 * end + axis;
      const units = unitsOf(eye[axis], quanta[axis]);
      this.quanta[at] = quanta[axis];
      this.rest[at] = eye[axis] - units * quanta[axis];
      this.turns[at] = turns[axis];
      this.eye[at] = units;
    }
  }

  fill(gl: WebGL2RenderingContext, program: Program): void {
    gl.uniform3fv(program.at("u_quanta"), this.quanta);
    gl.uniform3fv(program.at("u_rest"), this.rest);
    gl.uniform3iv(program.at("u_lengths"), this.turns);
    gl.uniform3iv(program.at("u_eyes"), this.eye);
  }
}
