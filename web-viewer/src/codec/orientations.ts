import { tabulate } from "./quantity_values";

const magnitudes = tabulate(19); // of a component of an angular velocity by code, in units

/**
 * The orientations of the spheres, integrated from the angular velocities of frames. Each sphere begins with an
 * arbitrary orientation, which depends on its place alone. An orientation is the vector of its modified Rodrigues
 * parameters: the axis times the tangent of a quarter of the angle, at most 1 long.
 */
export class Orientations {
  readonly values: Float32Array; // three per sphere, by place
  private time: number | undefined; // s: simulated, of the orientations

  constructor(count: number) {
    this.values = Float32Array.from({ length: 3 * count }, (_, k) => {
      const hash = Math.imul(k + 1, 0x9e3779b1);
      return (Math.imul(hash ^ (hash >>> 15), 0x85ebca77) / 2 ** 31) * 0.57;
    });
  }

  /**
   * Turns the spheres up to a time (s). `units`: three codes per sphere, in frame order, of the angular velocity since
   * the last call (docs/codec.md). `ids`: the place of each sphere in frame order. `unit`: rad/s, of the codes.
   */
  turn(units: Int32Array, ids: Uint32Array, unit: number, time: number): void {
    const { values } = this;
    const half = 0.5 * unit * Math.max(0, time - (this.time ?? time));
    this.time = time;
    if (half === 0) return;
    for (let k = 0, from = 0; k < ids.length; k++, from += 3) {
      const codeX = units[from] as number;
      const codeY = units[from + 1] as number;
      const codeZ = units[from + 2] as number;
      if ((codeX | codeY | codeZ) === 0) continue;
      // Half the angle by which the sphere turns, as a vector, and the quaternion (x, y, z, w) of the turn.
      let x = half * componentOf(codeX);
      let y = half * componentOf(codeY);
      let z = half * componentOf(codeZ);
      const angle = Math.sqrt(x * x + y * y + z * z);
      if (!(angle < 1e6)) continue; // not finite
      const w = Math.cos(angle);
      const sine = Math.sin(angle) / angle;
      x *= sine;
      y *= sine;
      z *= sine;
      const to = 3 * (ids[k] as number);
      const px = values[to] as number;
      const py = values[to + 1] as number;
      const pz = values[to + 2] as number;
      // The quaternion before: (2 p, 1 - p²) / (1 + p²). The common factor cancels out below.
      const p2 = px * px + py * py + pz * pz;
      const v = 1 - p2;
      const qw = w * v - 2 * (x * px + y * py + z * pz);
      const scale = 1 / (Math.abs(qw) + 1 + p2); // of the vector, to the parameters of q or -q
      const sign = qw < 0 ? -scale : scale;
      values[to] = sign * (2 * (w * px + y * pz - z * py) + x * v);
      values[to + 1] = sign * (2 * (w * py + z * px - x * pz) + y * v);
      values[to + 2] = sign * (2 * (w * pz + x * py - y * px) + z * v);
    }
  }
}

/** A component of an angular velocity, in units. */
function componentOf(code: number): number {
  return (code < 0 ? -1 : 1) * (magnitudes[Math.abs(code)] ?? Infinity);
}
