import type { Outcome } from "../connection/link";
import type { Vec3 } from "../model/facts";

const period = 50; // ms: the point is sent at most this often
const refresh = 250; // ms: and at least this often, because the answer tells the force

/** A sphere that this page pulls to a point. */
export class Pull {
  sphere: number | undefined; // id; undefined: none is pulled
  point: Vec3 = [0, 0, 0]; // m
  plane: Vec3 | undefined; // a point of the plane in which the pointer moves
  force: Vec3 | undefined; // N, as the server told last
  private offset: Vec3 = [0, 0, 0]; // m: from the pointer to the sphere when it was grabbed
  private sent = -Infinity; // ms
  private waits = false; // for an answer
  private due: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly send: (sphere: number, point: Vec3) => Promise<Outcome>,
    private readonly release: () => void,
  ) {}

  /** `at`: the place of the sphere. `pointer`: of the pointer, in the same plane. */
  grab(sphere: number, at: Vec3, pointer: Vec3): void {
    this.sphere = sphere;
    this.plane = this.point = at;
    this.force = undefined;
    this.offset = at.map((part, k) => part - (pointer[k] ?? 0)) as Vec3;
  }

  drag(pointer: Vec3): void {
    if (this.sphere === undefined) return;
    this.point = pointer.map((part, k) => part + (this.offset[k] ?? 0)) as Vec3;
    if (!this.waits) this.plan(period);
  }

  /** Returns false if no sphere was pulled. */
  letGo(): boolean {
    if (this.sphere === undefined) return false;
    const begun = this.sent !== -Infinity;
    this.stop();
    if (begun) this.release();
    return true;
  }

  private stop(): void {
    clearTimeout(this.due);
    this.due = undefined;
    this.sphere = this.plane = this.force = undefined;
    this.sent = -Infinity;
  }

  private plan(wait: number): void {
    clearTimeout(this.due);
    this.due = setTimeout(() => void this.sendNow(), Math.max(0, this.sent + wait - performance.now()));
  }

  private async sendNow(): Promise<void> {
    const { sphere, point } = this;
    if (sphere === undefined || this.waits) return;
    this.sent = performance.now();
    this.waits = true;
    const outcome = await this.send(sphere, point);
    this.waits = false;
    if (this.sphere !== sphere) {
      if (this.sphere !== undefined) this.plan(period);
    } else if (outcome.case !== "applied") {
      this.stop();
    } else {
      const [x = 0, y = 0, z = 0] = outcome.value.force;
      this.force = [x, y, z];
      this.plan(point === this.point ? refresh : period);
    }
  }
}
