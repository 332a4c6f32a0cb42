import { periodsOf } from "../connection/periods";
import type { MeshFacts, SceneFacts } from "../gen/spherule/v1/facts_pb";
import type { Obstacle as Message } from "../gen/spherule/v1/obstacle_pb";
import { Face } from "../gen/spherule/v1/scene_pb";
import type { Light as LightMessage } from "../gen/spherule/v1/scene_pb";
import { hexToRgb } from "../colour/rgb";
import type { Rgb } from "../colour/rgb";
import { placementOf } from "./placement";
import type { Placement } from "./placement";
import { Population } from "./population";

export type Vec3 = [number, number, number];

export interface Obstacle {
  shape: Message["shape"]; // as in scene.proto
  placement?: Placement | undefined;
  pivot?: Vec3 | undefined; // m: about which it turns, at the beginning; undefined: it is at rest
  colour: Rgb | undefined;
  triangles?: MeshFacts | undefined; // of a mesh
}

/** The light that the scene asks for; what is undefined is the page's choice. */
export interface Light {
  direction: Vec3 | undefined; // to the light; any length
  strength: number; // relative to the usual light
  colour: Rgb | undefined;
  sky: number; // strength of the light from all sides, relative to the usual one
}

/** The facts of a scene: constant within an epoch, except for the population. Lengths are in m. */
export interface Facts {
  epoch: number;
  name: string;
  description: string;
  whatToTry: string; // may be empty
  min: Vec3;
  max: Vec3;
  open: Set<Face>;
  periods: Vec3; // m: length of each periodic axis; 0: not periodic
  obstacles: Obstacle[];
  population: Population;
  origin: Vec3; // the centre of the bounds; positions in states are relative to it
  cellSize: number; // m; 0 if there is no grid
  cells: Vec3;
  cellWidths: Vec3; // m, per axis
  eye: Vec3 | undefined;
  target: Vec3 | undefined;
  fieldOfView: number; // degrees, vertical
  light: Light | undefined; // undefined: the page's choice
}

export function factsOf(scene: SceneFacts): Facts {
  const min = vec3(scene.boundsMin);
  const max = vec3(scene.boundsMax);
  const periods = periodsOf(scene);
  const cells = vec3(scene.cells);
  return {
    epoch: scene.epoch,
    name: scene.name,
    description: scene.description,
    whatToTry: scene.whatToTry,
    min,
    max,
    open: new Set(scene.open),
    periods,
    obstacles: scene.obstacles.map((message, number) => ({
      ...obstacleOf(message),
      triangles: scene.meshes.find(({ obstacle }) => obstacle === number),
    })),
    population: new Population(scene),
    origin: between(min, max),
    cellSize: scene.cellSize,
    cells,
    cellWidths: periods.map((length, axis) => (cells[axis] && length / cells[axis]) || scene.cellSize) as Vec3,
    eye: scene.camera?.eye.length === 3 ? vec3(scene.camera.eye) : undefined,
    target: scene.camera?.target.length === 3 ? vec3(scene.camera.target) : undefined,
    fieldOfView: scene.camera?.fieldOfView ?? 30,
    light: scene.light && lightOf(scene.light),
  };
}

function obstacleOf(message: Message): Obstacle {
  const { shape, colour, motion } = message;
  return { shape, placement: placementOf(message), pivot: motion && vec3(motion.pivot), colour: hexToRgb(colour) };
}

function lightOf({ direction, strength, colour, sky }: LightMessage): Light {
  return {
    direction: direction.length === 3 ? vec3(direction) : undefined,
    strength: strength ?? 1,
    colour: hexToRgb(colour),
    sky: sky ?? 1,
  };
}

/** Whether a face of the bounds is a wall: not open, and not of a periodic axis. */
export function isWall({ open, periods }: Facts, face: Face): boolean {
  return !open.has(face) && !periods[(face - Face.X_MIN) >> 1];
}

function between(a: Vec3, b: Vec3): Vec3 {
  return [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])];
}

function vec3(numbers: readonly number[]): Vec3 {
  return [numbers[0] ?? 0, numbers[1] ?? 0, numbers[2] ?? 0];
}
