import type { MessageInitShape } from "@bufbuild/protobuf";
import type { SetSchema } from "../gen/spherule/v1/control_pb";
import type { SceneSchema } from "../gen/spherule/v1/scene_pb";
import * as format from "../format";
import type { CommandKind, Link, Outcome } from "./link";
import type { CommandCase } from "./messages";

/** The result of a command. */
export interface Report {
  name: string; // of the command, for the user
  outcome: Outcome;
  text: string; // the outcome, for the user; of a refusal: in the words of the server
  quiet: boolean; // report only failures: a success is visible anyway
}

/** Spheres to add in a box; lengths in m. */
export interface Drop {
  min: number[];
  max: number[];
  count: number;
  radius: number;
}

/** A line of sight; origin in m, direction of unit length. */
export interface PushRay {
  origin: number[];
  direction: number[];
}

/**
 * Sends commands. Each result is also passed to `report`. `local`: whether the page carries out the command itself.
 * Sends nothing else while `blocked` returns true.
 */
export class Commands {
  constructor(
    private readonly link: Link,
    private readonly report: (report: Report) => void,
    private readonly local: (command: CommandCase) => boolean,
    private readonly blocked: (command: CommandCase) => boolean,
  ) {}

  pause(): Promise<Outcome> {
    return this.send("Pause", { case: "pause", value: {} });
  }

  resume(): Promise<Outcome> {
    return this.send("Resume", { case: "resume", value: {} });
  }

  /** `unit`: the name of a step in the report. */
  step(count: number, unit = "step"): Promise<Outcome> {
    const name = count === 1 ? `One ${unit}` : `${format.count(count)} ${unit}s`;
    return this.send(name, { case: "step", value: { count } });
  }

  reset(name = "Reset"): Promise<Outcome> {
    return this.send(name, { case: "reset", value: {} });
  }

  cancel(): Promise<Outcome> {
    return this.send("Cancel", { case: "cancel", value: {} }, true);
  }

  seek(time: number): Promise<Outcome> {
    return this.send("Seek", { case: "seek", value: { time } }, true);
  }

  startRecording(): Promise<Outcome> {
    return this.send("Record", { case: "startRecording", value: {} }, true);
  }

  stopRecording(): Promise<Outcome> {
    return this.send("Stop recording", { case: "stopRecording", value: {} }, true);
  }

  load(name: string): Promise<Outcome> {
    return this.send(`Scene ${name}`, { case: "load", value: { source: { case: "name", value: name } } });
  }

  /** `scene`: a message that another part of the page has read. */
  loadScene(name: string, scene: MessageInitShape<typeof SceneSchema>): Promise<Outcome> {
    return this.send(name, { case: "load", value: { source: { case: "scene", value: scene } } }, true);
  }

  set(name: string, settings: MessageInitShape<typeof SetSchema>, quiet = false): Promise<Outcome> {
    return this.send(name, { case: "set", value: settings }, quiet);
  }

  /** Changes a part of the scene. The place of the part shows how it ends. */
  change(name: string, kind: CommandKind): Promise<Outcome> {
    return this.send(name, kind, true);
  }

  /** Pulls a sphere to a point (m). */
  pull(sphere: number, point: readonly number[]): Promise<Outcome> {
    return this.send("Pull", { case: "pull", value: { sphere: BigInt(sphere), point: [...point] } }, true);
  }

  release(): Promise<Outcome> {
    return this.send("Release", { case: "release", value: {} }, true);
  }

  drop({ min, max, count, radius }: Drop): Promise<Outcome> {
    const amount = { case: "count" as const, value: count };
    const fill = { min, max, amount, seed: BigInt(Date.now()) };
    const group = {
      name: "dropped",
      source: { case: "fill" as const, value: fill },
      radius: { kind: { case: "constant" as const, value: radius } },
    };
    return this.send(`Drop ${format.count(count)}`, { case: "spawn", value: { group } });
  }

  /** `sphere`: id. */
  remove(sphere: number): Promise<Outcome> {
    return this.send(`Remove sphere ${format.count(sphere)}`, { case: "remove", value: { spheres: [BigInt(sphere)] } });
  }

  /** Asks for the state of a sphere. It is not reported. `sphere`: id. */
  inspect(sphere: number): Promise<Outcome> {
    return this.link.send({ case: "inspect", value: { sphere: BigInt(sphere) } });
  }

  /** Pushes a sphere along the ray. If its id is undefined, the server picks the first sphere that the ray meets. */
  push(ray: PushRay, sphere: number | undefined, newtonSeconds: number): Promise<Outcome> {
    const impulse = ray.direction.map((part) => part * newtonSeconds);
    const target =
      sphere === undefined ? { case: "ray" as const, value: ray } : { case: "sphere" as const, value: BigInt(sphere) };
    const name = sphere === undefined ? "Push" : `Push sphere ${format.count(sphere)}`;
    return this.send(name, { case: "push", value: { target, impulse } });
  }

  private async send(name: string, kind: CommandKind, quiet = false): Promise<Outcome> {
    const local = this.local(kind.case);
    if (!local && this.blocked(kind.case)) return { case: "lost" };
    const outcome = await this.link.send(kind, local);
    this.report({ name, outcome, text: textFor(outcome), quiet });
    return outcome;
  }
}

/** The newest reports, oldest first. */
export class ReportLog {
  private static readonly capacity = 50;
  readonly list: Report[] = [];

  add(report: Report): void {
    this.list.push(report);
    this.list.splice(0, this.list.length - ReportLog.capacity);
  }
}

function textFor({ case: kind, value }: Outcome): string {
  switch (kind) {
    case "applied":
      return value.removed === undefined
        ? `applied at step ${format.count(value.step)}`
        : `removed ${format.count(value.removed)} ${value.removed === 1n ? "sphere" : "spheres"}`;
    case "refused":
      return value.field ? `${value.field} ${value.reason}` : value.reason;
    default:
      return "The connection ended before the answer. Look whether it was carried out.";
  }
}
