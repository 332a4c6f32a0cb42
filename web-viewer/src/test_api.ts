import type { Pose } from "./camera/orbit";
import { project } from "./camera/ray";
import { sharedNow } from "./clock";
import type { Report } from "./connection/commands";
import type { Vec3 } from "./model/facts";
import { positionOf } from "./model/positions";
import type { Session } from "./model/session";
import { timeOf } from "./model/states";
import type { Viewer } from "./viewer";

/**
 * `window.spherule`: read-only access for tests to all that the DOM does not show, of the first viewer of the page.
 * Elements are found by their `data-testid`. Commands are sent through the page's controls or the server's protocol.
 * perf_marks.ts lists the performance marks of the first image.
 */
export interface TestApi {
  readonly session: Session;
  readonly reports: readonly Report[]; // results of this page's commands, the newest last
  readonly drawn: number; // images since the page was loaded
  /** `toClip`: of the image, from positions relative to the eye to clip space, column after column. */
  readonly camera: Pose & { eye: Vec3; toClip: number[] };
  /** Simulated times (s): of the image, and of the two states from which it is interpolated. */
  readonly shown: { time: number; from: number; to: number } | undefined;
  /** Whether a seek in the recording is in progress. */
  readonly seeking: boolean;
  /** Number of spheres in the scene. */
  readonly spheres: number | undefined;
  /** Id of the selected sphere. */
  readonly selected: number | undefined;
  /** Positions of spheres in the newest state (m); each is off by at most half a quantum on each axis. */
  positions(ids: number[]): { step: number; quantum: number; positions: (Vec3 | undefined)[] } | undefined;
  /** The id of the sphere that is drawn at a point of the canvas (CSS pixels). */
  at(x: number, y: number): number | undefined;
  /** The places of the spheres that the image shows, row after row from the top; negative: none. */
  readonly places: { width: number; height: number; places: number[] } | undefined;
  /** Projects a point (m) to the canvas (CSS pixels); undefined if it lies behind the eye. */
  project(point: Vec3): [number, number] | undefined;
}

declare global {
  interface Window {
    spherule: TestApi;
  }
}

export function createTestApi(viewer: Viewer): TestApi {
  const { session, camera, canvas, reports, page } = viewer;
  return {
    session,
    reports: reports.list,
    get drawn() {
      return canvas.drawn;
    },
    get camera() {
      return { ...camera.pose, eye: camera.last.eye, toClip: [...camera.last.toClip] };
    },
    get shown() {
      const shown = session.states.shown(sharedNow());
      return shown && { time: timeOf(shown), from: shown.from.simTime, to: shown.to.simTime };
    },
    get seeking() {
      return page.playback.seeking;
    },
    get spheres() {
      return session.facts?.population.count;
    },
    get selected() {
      return page.inspector.selection.id;
    },
    positions(ids) {
      const { facts, newest: state } = session;
      if (!state || !facts) return undefined;
      const { quantum } = state.columns.position;
      const places = ids.map((id) => facts.population.placeOf(id));
      const positions = places.map((place) => (place === undefined ? undefined : positionOf(facts, state, place)));
      return { step: state.step, quantum, positions };
    },
    at(x, y) {
      const place = viewer.placeAt(x, y);
      return place === undefined ? undefined : session.facts?.population.idOf(place);
    },
    get places() {
      const drawn = canvas.places();
      return drawn && { ...drawn, places: [...drawn.places] };
    },
    project: (point) => project(camera.last, point),
  };
}
