import { create } from "@bufbuild/protobuf";
import { SettingsSchema, TimelineSchema, WelcomeSchema } from "../gen/spherule/v1/control_pb";
import type { Settings } from "../gen/spherule/v1/control_pb";
import { sharedNow } from "../clock";
import type { RecordingContent } from "./archive_messages";
import type { BufferPool } from "./buffer_pool";
import { History } from "./history";
import type { CommandMessage } from "./messages";
import type { PagePort } from "./page_port";
import { Replay } from "./replay";

/** Plays a recording without a server: sends the page what a server would send that plays it. */
export class FilePlayback {
  readonly replay: Replay;
  private readonly history = new History();
  private readonly settings: Settings;

  constructor(
    name: string,
    content: RecordingContent,
    buffers: BufferPool,
    private readonly port: PagePort,
  ) {
    const { history } = this;
    for (const { entries, begin, ...start } of content.segments) {
      history.open(start, begin);
      for (const entry of entries) history.add(entry);
    }
    // The frames of a recording have no angular velocities.
    this.settings = { ...(content.settings ?? create(SettingsSchema, {})), rotates: false };
    this.replay = new Replay("file", history, false, buffers, port, () => {
      this.replay.pause();
      this.tellSettings();
    });
    const { server = "", device = "", renderer = "" } = content.source ?? {};
    const { begin, end, frames } = history;
    const timeline = { file: name, begin, end, frames: BigInt(frames), flaw: content.flaw };
    port.post({ kind: "link", state: "connecting", at: sharedNow() });
    port.post({ kind: "past", past: undefined });
    port.post({ kind: "replay", replay: this.replay.state });
    port.post({ kind: "link", state: "open", at: sharedNow() });
    port.post({ kind: "welcome", welcome: create(WelcomeSchema, { server, device, renderer, reason: "recorded" }) });
    port.post({ kind: "timeline", timeline: create(TimelineSchema, timeline) });
    this.carryOut({ kind: { case: "reset", value: {} } });
    for (const text of content.damage) port.post({ kind: "told", title: `Damage in ${name}`, text });
  }

  carryOut(command: CommandMessage): void {
    this.replay.carryOut(command);
    this.tellSettings();
  }

  private tellSettings(): void {
    const { speed, state } = this.replay;
    this.port.post({ kind: "settings", settings: { ...this.settings, speed, paused: state.paused } });
  }
}
