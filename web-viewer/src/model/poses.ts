import * as vec3 from "gl-matrix/esm/vec3.js";
import type { Pose } from "../gen/spherule/v1/frame_pb";
import type { Placement } from "./placement";
import type { State } from "./states";

type Vec3 = Placement["move"];
type Posed = Pick<State, "poses">;

const rest = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };
const [before, after]: [Vec3, Vec3] = [
  [0, 0, 0],
  [0, 0, 0],
];

function poseIn({ poses }: Posed, obstacle: number): Pose | typeof rest {
  // They are in the order of the obstacles.
  for (let k = Math.min(obstacle, poses.length - 1); k >= 0; k--) {
    const pose = poses[k] as Pose;
    if (pose.obstacle <= obstacle) return pose.obstacle === obstacle ? pose : rest;
  }
  return rest;
}

/** Where the pivot is in a pose (m). */
function pivotIn({ translation, rotation }: typeof rest, pivot: Vec3, into: Vec3): Vec3 {
  vec3.transformQuat(into, pivot, rotation);
  return vec3.add(into, into, translation) as Vec3;
}

/**
 * Writes where an obstacle is between two states: its point x is at move + turn (x - pivot). The pivot moves along a
 * line, and the obstacle turns by the short way. Allocates nothing.
 */
export function writePose(
  { turn, move }: Placement,
  { from, to, mix }: { from: Posed; to: Posed; mix: number },
  obstacle: number,
  pivot: Vec3,
): void {
  const begin = poseIn(from, obstacle);
  const end = poseIn(to, obstacle);
  vec3.lerp(move, pivotIn(begin, pivot, before), pivotIn(end, pivot, after), mix);
  let same = 0;
  for (let k = 0; k < 4; k++) same += (begin.rotation[k] as number) * (end.rotation[k] as number);
  let length = 0;
  for (let k = 0; k < 4; k++) {
    const part = (1 - mix) * (begin.rotation[k] as number) + (same < 0 ? -mix : mix) * (end.rotation[k] as number);
    turn[k] = part;
    length += part * part;
  }
  for (let k = 0; k < 4; k++) turn[k] = (turn[k] as number) / Math.sqrt(length);
}
