import { project } from "./camera/ray";
import type { Pose } from "./camera/orbit";
import { Model } from "./gen/spherule/v1/scene_pb";
import { sharedNow } from "./clock";
import type { Report } from "./connection/commands";
import { tierName } from "./connection/wish";
import type { Facts, Vec3 } from "./scene/facts";
import { positionOf } from "./scene/positions";
import { timeOf } from "./scene/states";
import type { Viewer } from "./viewer";

/**
 * `window.spherule`: what tests and curious people may rely on. Elements are found by their `data-testid`; the
 * simulation is told what to do through the page's controls or the server's own protocol, not from here. How the first picture
 * came about is in the browser's performance marks: `spherule:connecting`, `open`, `scene`, `arrived` (the first state, at the
 * worker), `decoded` (it is here), `drawn` (its picture has been handed to the browser).
 */
export interface Hook {
  /** "connecting", "open", "silent" (open, but the server does not answer) "waiting" (for the next attempt) or "locked" (a token is needed). */
  readonly connection: string;
  /** Size of the canvas in its own pixels, pictures drawn since the page was loaded. */
  readonly picture: { width: number; height: number; drawn: number; contextLost: boolean };
  /** Of the newest state; -1 where there is none. */
  readonly step: number;
  readonly simTime: number; // s
  readonly epoch: number;
  readonly count: number;
  readonly paused: boolean;
  /** States taken since the page was loaded. */
  readonly frames: number;
  readonly scene: string;
  readonly facts: Facts | undefined;
  readonly settings: HeldSettings | undefined;
  /** What holds the substeps: a time in ms or a mean overlap over the radius; undefined: nothing. */
  readonly auto: { budgetMs?: number; overlap?: number } | undefined;
  /** The newest figures of the world that the server sent. */
  readonly diagnostics: { substeps: number; stepMs: number; energyRises: boolean; step: number } | undefined;
  /** The positions of the dial, from fast to accurate. */
  readonly dial: { model: string; substeps: number; stepMs: number; own: boolean }[];
  /** "everybody" (steers), "watching", "free" (nobody has the controls), "mine" or "taken"; and this page's number. */
  readonly standing: string;
  readonly session: number;
  /** Simulated times, s: of the picture, and of the two states that it is mixed of. */
  readonly shown: { time: number; from: number; to: number } | undefined;
  /** Of a server that plays a recording: what there is to play, where the handle stands, and whether it waits for a seek. */
  readonly timeline: PlayedTimeline | undefined;
  /** What a server that simulates has recorded. */
  readonly recording: { active: boolean; file: string; duration: number; bytes: number; failure: string } | undefined;
  readonly camera: Pose & { eye: Vec3 };
  /** Answers to this page's commands, the newest last, at most 50. */
  readonly results: { what: string; outcome: string; step: number | undefined; words: string }[];
  /** In the newest state, in metres, with its step; off by at most half its quantum per axis. */
  positions(ids: number[]): { step: number; quantum: number; positions: Vec3[] } | undefined;
  /** What the server says that it sends, and what that takes; undefined where it has said nothing. */
  stream(): StreamFigures | undefined;
  /** The sphere that is seen at this place of the page, in CSS pixels. */
  at(x: number, y: number): number | undefined;
  /** Where a place in metres lies on the page, in CSS pixels; undefined behind the eye. */
  project(place: Vec3): [number, number] | undefined;
}

/** Figures are means over two seconds; NaN where no frame came. */
export interface StreamFigures {
  tier: string; // "fine", "normal" or "eco"
  rate: number; // frames per second
  reduced: boolean; // less than the page wants
  reason: string; // of the last change
  bytesPerSphere: number; // of a frame
  decodeMs: number; // of a frame
  lost: number; // frames that could not be decoded since the page was loaded
}

/** Times in s. */
export interface PlayedTimeline {
  file: string;
  begin: number;
  end: number;
  frames: number;
  flaw: string;
  time: number; // where the handle stands
  seeking: boolean;
}

/** What holds on the server; `model`: "fast", "balanced" or "accurate". */
export interface HeldSettings {
  gravity: number[];
  restitution: number;
  friction: number;
  model: string;
  substeps: number;
  speed: number;
  paused: boolean;
}

declare global {
  interface Window {
    spherule: Hook;
  }
}

const kept = 50;

export class Reports {
  readonly list: Report[] = [];

  add(report: Report): void {
    this.list.push(report);
    this.list.splice(0, this.list.length - kept);
  }
}

export function hookFor({ session, camera, stage, reports, page, seenAt }: Viewer): Hook {
  return {
    get connection() {
      return session.silentSince === undefined ? session.link : "silent";
    },
    get picture() {
      const { width, height } = stage.canvas;
      return { width, height, drawn: stage.drawn, contextLost: stage.contextLost };
    },
    get step() {
      return session.states.newest?.step ?? -1;
    },
    get simTime() {
      return session.states.newest?.simTime ?? 0;
    },
    get epoch() {
      return session.facts?.epoch ?? -1;
    },
    get count() {
      return session.facts?.count ?? 0;
    },
    get paused() {
      return session.paused;
    },
    get frames() {
      return session.frames;
    },
    get scene() {
      return session.facts?.name ?? "";
    },
    get facts() {
      return session.facts;
    },
    get settings() {
      if (!session.settings) return undefined;
      const { gravity, restitution, friction, substeps, speed, paused } = session.settings;
      const model = Model[session.settings.model].toLowerCase();
      return { gravity, restitution, friction, model, substeps, speed, paused };
    },
    get auto() {
      const goal = session.settings?.auto?.goal;
      return goal?.case ? { [goal.case]: goal.value } : undefined;
    },
    get diagnostics() {
      const { substeps, stepMs, energyRises, statistics } = session.diagnostics ?? {};
      if (substeps === undefined || stepMs === undefined || energyRises === undefined) return undefined;
      return { substeps, stepMs, energyRises, step: Number(statistics?.step ?? 0) };
    },
    get dial() {
      return (session.dial?.positions ?? []).map(({ model, substeps, stepMs, own }) => ({
        model: Model[model].toLowerCase(),
        substeps,
        stepMs,
        own,
      }));
    },
    get standing() {
      return page.steering.standing.kind;
    },
    get session() {
      return Number(session.welcome?.session ?? 0);
    },
    get shown() {
      const shown = session.states.shown(sharedNow());
      return shown && { time: timeOf(shown), from: shown.from.simTime, to: shown.to.simTime };
    },
    get timeline() {
      if (!session.timeline) return undefined;
      const { file, begin, end, frames, flaw } = session.timeline;
      return { file, begin, end, frames: Number(frames), flaw, time: page.playback.time, seeking: page.playback.seeking };
    },
    get recording() {
      if (!session.recording) return undefined;
      const { active, file, duration, bytes, failure } = session.recording;
      return { active, file, duration, bytes: Number(bytes), failure };
    },
    get camera() {
      return { ...camera.pose, eye: camera.last.eye };
    },
    get results() {
      return reports.list.map(({ what, outcome, words }) => ({
        what,
        outcome: outcome.case ?? "unknown",
        step: outcome.case === "applied" ? Number(outcome.value.step) : undefined,
        words,
      }));
    },
    positions(ids) {
      const state = session.states.newest;
      const facts = session.facts;
      if (!state || !facts) return undefined;
      return { step: state.step, quantum: state.quantum, positions: ids.map((id) => positionOf(facts, state, id)) };
    },
    stream() {
      if (!session.stream) return undefined;
      const { tier, rate, reduced, reason } = session.stream;
      const { bytesPerSphere, decodeMs } = session.traffic.rates(sharedNow());
      return { tier: tierName(tier), rate, reduced, reason, bytesPerSphere, decodeMs, lost: session.lost };
    },
    at: (x, y) => seenAt(x, y),
    project: (place) => project(camera.last, place),
  };
}
