import { create } from "@bufbuild/protobuf";
import type { MessageInitShape } from "@bufbuild/protobuf";
import { CommandResultSchema } from "../gen/spherule/v1/control_pb";
import { Refused_Cause } from "../gen/spherule/v1/refused_pb";
import type { RefusedSchema } from "../gen/spherule/v1/refused_pb";
import type { BufferPool } from "./buffer_pool";
import type { History } from "./history";
import type { CommandMessage, ReplayState } from "./messages";
import type { PagePort } from "./page_port";
import { Player } from "./player";

const mostSteps = 100_000;
const [slowest, fastest] = [0.001, 1000];

/** Shows frames of a history in place of live ones, and answers the commands of playback as a server does. */
export class Replay {
  speed = 1; // of playback
  private step = 0n; // of the frame that is shown
  private readonly player: Player;

  /** Shows nothing before the first command. `ended`: there is no further frame. */
  constructor(
    readonly source: ReplayState["source"],
    private readonly history: History,
    paused: boolean,
    buffers: BufferPool,
    private readonly port: PagePort,
    ended: () => void,
  ) {
    this.player = new Player(history, source === "file", buffers, {
      scene: (facts) => port.post({ kind: "scene", facts, jump: true }),
      population: (population) => port.post({ kind: "population", population }),
      frame: (frame, frames) => {
        this.step = BigInt(frame.step);
        port.show(frame, frames);
      },
      damaged: (reason) => port.post({ kind: "unreadable", reason }),
      ended,
    });
    this.player.paused = paused;
  }

  get state(): ReplayState {
    return { source: this.source, paused: this.player.paused };
  }

  pause(): void {
    this.player.pause();
    this.tell();
  }

  stop(): void {
    this.player.stop();
  }

  carryOut({ id = 0n, kind }: CommandMessage): void {
    const refused = this.execute(kind);
    const applied = { case: "applied" as const, value: { step: this.step } };
    const outcome = refused ? { case: "refused" as const, value: refused } : applied;
    this.port.post({ kind: "result", result: create(CommandResultSchema, { id, outcome }) });
    this.tell();
  }

  /** Returns why the command is refused; undefined if it was carried out. */
  private execute(kind: CommandMessage["kind"]): MessageInitShape<typeof RefusedSchema> | undefined {
    const { player, history } = this;
    switch (kind?.case) {
      case "pause":
        player.pause();
        return undefined;
      case "resume":
        if (this.source === "file" && player.atEnd) player.seek(history.begin);
        player.resume();
        return undefined;
      case "step": {
        const { count = 0 } = kind.value;
        if (!(count >= 1 && count <= mostSteps)) return outside("step.count", count, 1, mostSteps);
        player.step(count);
        return undefined;
      }
      case "seek":
        player.seek(kind.value.time ?? 0);
        return undefined;
      case "reset":
        player.seek(history.begin);
        return undefined;
      case "set": {
        const { speed = 1 } = kind.value;
        if (!(speed >= slowest && speed <= fastest)) return outside("set.speed", speed, slowest, fastest);
        player.setSpeed(speed);
        this.speed = speed;
        return undefined;
      }
      default:
        return { cause: Refused_Cause.PLAYBACK, reason: "a file is played here: nothing in it can be changed" };
    }
  }

  private tell(): void {
    this.port.post({ kind: "replay", replay: this.state });
  }
}

function outside(field: string, value: number, least: number, most: number): MessageInitShape<typeof RefusedSchema> {
  const reason = `is ${value}, must be from ${least} to ${most}`;
  return { cause: Refused_Cause.RANGE, field, reason, least, most };
}
