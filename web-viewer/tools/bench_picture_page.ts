// The page of bench_picture.mjs: draws the same spheres with this page's renderer, and with three.js.
import { create } from "@bufbuild/protobuf";
import * as vec3 from "gl-matrix/esm/vec3.js";
import * as THREE from "three";
import { Camera } from "../src/camera/camera";
import { rayThrough } from "../src/camera/ray";
import type { Ray } from "../src/camera/ray";
import { SceneFactsSchema } from "../src/gen/spherule/v1/facts_pb";
import { noTurns } from "../src/codec/turns";
import { blockPlaces } from "../src/columns";
import type { Quanta } from "../src/columns";
import { boxesOf } from "../src/connection/order";
import type { DrawState } from "../src/renderer/draw_state";
import { everything } from "../src/model/cut";
import { factsOf } from "../src/model/facts";
import type { Facts } from "../src/model/facts";
import { shownPosition } from "../src/model/positions";
import type { Shown, State } from "../src/model/states";
import { FrameRenderer } from "../src/renderer/frame_renderer";
import { ladder } from "../src/renderer/render_quality";
import { themes } from "../src/renderer/theme";

const radius = 0.05; // m
const side = 24; // spheres
const width = 1280;
const height = 720;

/** A pile of spheres that touch, a little disturbed, in the order of their blocks. */
function pile(count: number): { positions: Float32Array; high: number } {
  const positions = new Float32Array(3 * count);
  const across = Math.ceil(Math.sqrt(count / side));
  let random = 1;
  const next = (): number => (random = (random * 48271) % 0x7fffffff) / 0x7fffffff - 0.5;
  for (let k = 0; k < count; k++) {
    const cell = Math.floor(k / side); // a column of spheres after another, in tiles of 4 x 4 columns
    const tile = Math.floor(cell / 16);
    const tiles = Math.ceil(across / 4);
    const x = 4 * (tile % tiles) + (cell % 4);
    const y = 4 * Math.floor(tile / tiles) + (Math.floor(cell / 4) % 4);
    const z = k % side;
    [x, y, z].forEach((part, axis) => {
      const middle = axis < 2 ? across / 2 : side / 2;
      positions[3 * k + axis] = 2 * radius * (part + 0.5 - middle + 0.3 * next());
    });
  }
  return { positions, high: across * radius };
}

function canvas(): HTMLCanvasElement {
  const made = document.createElement("canvas");
  made.width = width;
  made.height = height;
  document.body.append(made);
  return made;
}

interface Subject {
  gl: WebGL2RenderingContext | WebGLRenderingContext;
  draw(image: number): void;
  free(): void;
  /** Two ways to find the sphere at a pixel (from the upper left corner): its place. */
  picks?: Record<"byImage" | "byRays", (x: number, y: number) => number | undefined>;
}

/** The sphere that a ray meets first, found among all of them as the page did before it read the image. */
function firstOnRay(facts: Facts, shown: Shown, { origin, direction }: Ray): number | undefined {
  let [nearest, found]: [number, number | undefined] = [Infinity, undefined];
  for (let place = 0; place < shown.to.count; place++) {
    const to = vec3.subtract([0, 0, 0], shownPosition(facts, shown, place), origin);
    const along = vec3.dot(to, direction);
    const half = facts.population.radiusOf(place) ** 2 - (vec3.squaredLength(to) - along * along);
    if (half < 0 || along < 0) continue;
    const distance = along - Math.sqrt(half);
    if (distance < nearest) [nearest, found] = [distance, place];
  }
  return found;
}

function own(count: number, full: boolean): Subject {
  const { positions, high } = pile(count);
  const low = -side * radius;
  const bounds = { boundsMin: [-high, -high, low], boundsMax: [high, high, -low] };
  const facts = factsOf(create(SceneFactsSchema, { epoch: 1, count, radius, ...bounds }));
  const element = canvas();
  const gl = element.getContext("webgl2", { antialias: false, alpha: false, depth: false });
  if (!gl) throw new Error("no WebGL 2");
  const renderer = new FrameRenderer(gl);
  const quality = ladder[full ? 1 : 2];
  if (!quality) throw new Error("no such quality");
  renderer.setQuality(quality, width, height);
  const places = Uint32Array.from({ length: count }, (_, k) => k);
  renderer.setFacts(facts, themes.light, { epoch: 1, number: 1, places });
  const quanta: Quanta = [1e-6, 1e-6, 1e-6];
  const units = Int32Array.from(positions, (x) => Math.round(1e6 * x));
  const boxes = new Float64Array(6 * Math.ceil(count / blockPlaces));
  boxesOf(units, count, quanta, [0, 0, 0], boxes);
  const state = (sequence: number): State => ({
    sequence,
    epoch: 1,
    step: sequence,
    simTime: sequence,
    count,
    columns: { position: { values: units, quantum: quanta[0], quanta, turns: noTurns } },
    order: 1,
    boxes,
  });
  const camera = new Camera();
  camera.resize(width, height);
  camera.look(facts, false);
  const [from, to] = [state(1), state(2)];
  return {
    gl,
    draw(image) {
      camera.orbit(2, 0);
      camera.advance(1000, true);
      const shown: Shown = { from, to, mix: (image % 7) / 7, moving: true };
      const rest = { kept: everything, selected: undefined, trace: undefined, dim: 0 };
      const drawn: DrawState = { view: camera.view(), mode: "id", range: [0, count], ...rest };
      renderer.draw(shown, drawn);
    },
    picks: {
      byImage: (x, y) => renderer.placeAt(x, height - 1 - y),
      byRays: (x, y) => {
        const shown: Shown = { from, to, mix: 0, moving: true };
        return firstOnRay(facts, shown, rayThrough(camera.last, x + 0.5, y + 0.5));
      },
    },
    free: () => (element.remove(), gl.getExtension("WEBGL_lose_context")?.loseContext()),
  };
}

function three(count: number, full: boolean): Subject {
  const { positions, high } = pile(count);
  const element = canvas();
  const renderer = new THREE.WebGLRenderer({ canvas: element, antialias: full });
  renderer.setSize(width, height, false);
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = full ? THREE.PCFSoftShadowMap : THREE.BasicShadowMap;
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xe9edf0);
  const light = new THREE.DirectionalLight(0xffffff, 2);
  light.position.set(-high, -2 * high, 3 * high);
  light.castShadow = true;
  const reach = 2 * high;
  Object.assign(light.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, far: 10 * high });
  light.shadow.mapSize.setScalar(full ? 2048 : 1024);
  scene.add(light, new THREE.HemisphereLight(0xffffff, 0x888888, 1));
  const geometry = new THREE.IcosahedronGeometry(radius, 3); // 320 triangles
  const spheres = new THREE.InstancedMesh(geometry, new THREE.MeshStandardMaterial({ roughness: 0.45 }), count);
  spheres.castShadow = spheres.receiveShadow = true;
  const matrix = new THREE.Matrix4();
  const colour = new THREE.Color();
  for (let k = 0; k < count; k++) {
    const [x = 0, y = 0, z = 0] = positions.subarray(3 * k, 3 * k + 3);
    spheres.setMatrixAt(k, matrix.makeTranslation(x, y, z));
    spheres.setColorAt(k, colour.setHSL(k / count, 0.6, 0.5));
  }
  scene.add(spheres);
  const camera = new THREE.PerspectiveCamera(45, width / height, 0.1, 100 * high);
  camera.up.set(0, 0, 1);
  return {
    gl: renderer.getContext(),
    draw(image) {
      const angle = -1 + 0.012 * image;
      const far = 3.2 * high;
      camera.position.set(far * Math.cos(angle), far * Math.sin(angle), 1.3 * high);
      camera.lookAt(0, 0, 0);
      renderer.render(scene, camera);
    },
    free: () => (renderer.dispose(), renderer.forceContextLoss(), element.remove()),
  };
}

const pixel = new Uint8Array(4);

/** The time of an image (ms), mean of `images`. Waits until each is drawn. */
function time(subject: Subject, images: number): number {
  const { gl } = subject;
  const begin = performance.now();
  for (let k = 0; k < images; k++) {
    subject.draw(k);
    gl.readPixels(width / 2, height / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  }
  return (performance.now() - begin) / images;
}

let present: Subject | undefined;

/** Median times (ms) of finding the sphere at `tries` pixels, in both ways, and how often they agree. */
function pick(count: number, tries: number): { byImage: number; byRays: number; agree: number } {
  present?.free();
  present = own(count, false);
  time(present, 1);
  const { picks } = present;
  const times = { byImage: [] as number[], byRays: [] as number[] };
  let agree = 0;
  for (let k = 0; picks && k < tries; k++) {
    const found = (["byImage", "byRays"] as const).map((way) => {
      const begin = performance.now();
      const place = picks[way]((k * 389) % width, 200 + ((k * 211) % (height - 300)));
      times[way].push(performance.now() - begin);
      return place;
    });
    if (found[0] === found[1]) agree += 1;
  }
  const median = (list: number[]): number => list.sort((a, b) => a - b)[list.length >> 1] ?? NaN;
  return { byImage: median(times.byImage), byRays: median(times.byRays), agree };
}

Object.assign(window, {
  triangles: () => new THREE.IcosahedronGeometry(1, 3).attributes.position.count / 3,
  prepare(name: "own" | "three", count: number, full: boolean): void {
    present?.free();
    present = (name === "own" ? own : three)(count, full);
    time(present, 1);
  },
  pick,
  time: (images: number): number => (present ? time(present, images) : NaN),
});
