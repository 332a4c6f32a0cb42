import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import {
  CancelSchema,
  LoadSceneSchema,
  PauseSchema,
  PushSchema,
  ResetSchema,
  ResumeSchema,
  SeekSchema,
  SetSchema,
  SpawnSchema,
  StartRecordingSchema,
  StepSchema,
  StopRecordingSchema,
} from "../gen/spherule/v1/control_pb";
import type { Ray } from "../camera/ray";
import type { Vec3 } from "../scene/facts";
import type { CommandKind, Link, Outcome } from "./link";

/** A command with its answer, in words for the person who gave it. */
export interface Report {
  what: string;
  outcome: Outcome;
  words: string;
  quiet: boolean; // what was done is seen anyway: worth telling only where it was not done
}

export interface Drop {
  min: Vec3;
  max: Vec3;
  count: number;
  radius: number;
}

/** What the page can ask of the simulation. Each answer goes to `report` as well; nothing is asked while that is hindered. */
export class Commands {
  constructor(
    private readonly link: Link,
    private readonly report: (report: Report) => void,
    private readonly hindered: () => boolean,
  ) {}

  pause(): Promise<Outcome> {
    return this.give("Pause", { case: "pause", value: create(PauseSchema) });
  }

  resume(): Promise<Outcome> {
    return this.give("Resume", { case: "resume", value: create(ResumeSchema) });
  }

  /** `unit`: what a step is called. */
  step(count: number, unit = "step"): Promise<Outcome> {
    return this.give(count === 1 ? `One ${unit}` : `${count} ${unit}s`, { case: "step", value: create(StepSchema, { count }) });
  }

  reset(what = "Reset"): Promise<Outcome> {
    return this.give(what, { case: "reset", value: create(ResetSchema) });
  }

  cancel(): Promise<Outcome> {
    return this.give("Cancel", { case: "cancel", value: create(CancelSchema) }, true);
  }

  seek(time: number): Promise<Outcome> {
    return this.give("Seek", { case: "seek", value: create(SeekSchema, { time }) }, true);
  }

  record(): Promise<Outcome> {
    return this.give("Record", { case: "startRecording", value: create(StartRecordingSchema) }, true);
  }

  stopRecording(): Promise<Outcome> {
    return this.give("Stop recording", { case: "stopRecording", value: create(StopRecordingSchema) }, true);
  }

  load(name: string): Promise<Outcome> {
    const value = create(LoadSceneSchema, { source: { case: "name", value: name } });
    return this.give(`Scene ${name}`, { case: "load", value });
  }

  set(what: string, settings: MessageInitShape<typeof SetSchema>): Promise<Outcome> {
    return this.give(what, { case: "set", value: create(SetSchema, settings) });
  }

  drop({ min, max, count, radius }: Drop): Promise<Outcome> {
    const fill = { min, max, count, seed: BigInt(Date.now()) };
    const group = {
      name: "dropped",
      source: { case: "fill" as const, value: fill },
      radius: { kind: { case: "constant" as const, value: radius } },
    };
    return this.give(`Drop ${count}`, { case: "spawn", value: create(SpawnSchema, { group }) });
  }

  /** Pushes along the ray: the sphere that the page saw there, or, where it saw none, what the server finds. */
  push(ray: Ray, sphere: number | undefined, newtonSeconds: number): Promise<Outcome> {
    const impulse = ray.direction.map((part) => part * newtonSeconds);
    const target = sphere === undefined ? { case: "ray" as const, value: ray } : { case: "sphere" as const, value: sphere };
    const what = sphere === undefined ? "Push" : `Push sphere ${sphere}`;
    return this.give(what, { case: "push", value: create(PushSchema, { target, impulse }) });
  }

  private async give(what: string, kind: CommandKind, quiet = false): Promise<Outcome> {
    if (this.hindered()) return { case: "lost" };
    const outcome = await this.link.send(kind);
    this.report({ what, outcome, words: wordsFor(outcome), quiet });
    return outcome;
  }
}

function wordsFor(outcome: Outcome): string {
  switch (outcome.case) {
    case "applied":
      return `applied at step ${outcome.value.step}`;
    case "refused":
      return outcome.value.field ? `refused: ${outcome.value.field}: ${outcome.value.reason}` : `refused: ${outcome.value.reason}`;
    default:
      return "not sent: there is no connection";
  }
}
