import type { Timeline } from "../gen/spherule/v1/control_pb";
import { recordingTime } from "../format";
import { h, setText } from "./dom";

const longStep = 0.1; // of the recording, at most

/** The timeline of a recording: its present position, and a handle to seek. */
export class Scrubber {
  private readonly slider = h("input", {
    type: "range",
    step: "any",
    "data-testid": "timeline",
    "aria-label": "Position in the recording",
  });
  private readonly position = h("b", { "data-testid": "timeline-position" });
  private readonly file = h("span", { class: "file", "data-testid": "timeline-file" });
  private readonly range = h("span", { "data-testid": "timeline-range" });
  private readonly flaw = h("p", { class: "flaw", "data-testid": "timeline-flaw" });
  readonly element = h(
    "section",
    { class: "timeline", hidden: true, "aria-label": "Timeline" },
    h("div", { class: "reading" }, this.position, this.file, this.range),
    this.slider,
    this.flaw,
  );
  private timeline: Timeline | undefined;
  private newest = 0; // s: of the newest state, or the target of a seek; the handle moves towards it
  private still = false; // paused, and no seek is in progress
  private held = false; // the user holds the handle: the server does not move it

  /** `seek`: to a time (s); `released`: the user has released the handle. `step`: to the next frame. */
  constructor(
    private readonly seek: (time: number, released: boolean) => void,
    private readonly step: () => void,
  ) {
    this.slider.addEventListener("pointerdown", () => (this.held = true));
    this.slider.addEventListener("input", () => {
      this.describe();
      seek(this.time, false);
    });
    this.slider.addEventListener("change", () => seek(this.time, true));
    for (const end of ["pointerup", "pointercancel", "change", "blur"]) {
      this.slider.addEventListener(end, () => (this.held = false));
    }
    this.slider.addEventListener("keydown", (event) => this.pressed(event));
  }

  /** Returns true if the timeline has changed. */
  setTimeline(timeline: Timeline | undefined): boolean {
    if (timeline === this.timeline) return false;
    this.timeline = timeline;
    this.held = false;
    this.element.hidden = !timeline;
    if (timeline) this.describeRange(timeline);
    return true;
  }

  private describeRange(timeline: Timeline): void {
    const { file, begin, end, flaw } = timeline;
    this.slider.min = String(begin);
    this.slider.max = String(end);
    setText(this.file, file);
    this.file.title = `${file}, ${Number(timeline.frames)} frames`;
    const last = recordingTime(end, end - begin);
    setText(this.range, begin === 0 ? last : `${recordingTime(begin, end - begin)} – ${last}`);
    setText(this.flaw, flaw && `Ends early: ${flaw}`);
    this.flaw.hidden = !flaw;
    this.element.title = flaw ? `The recording is incomplete: ${flaw}` : "";
  }

  /**
   * `time`: of the image (s); `newest`: of the newest state, or the target of a seek (s); `still`: paused, and no seek
   * is in progress.
   */
  update(time: number | undefined, newest: number | undefined, still: boolean): void {
    this.newest = newest ?? this.newest;
    this.still = still;
    if (time === undefined || this.held) return;
    this.slider.value = String(time);
    this.describe();
  }

  /** `blockedReason`: why the user may not seek; empty if they may, or if there is no connection. */
  enable(usable: boolean, blockedReason: string): void {
    this.slider.disabled = !usable;
    this.slider.title = blockedReason;
    if (!usable) this.held = false; // a disabled slider has no further events
  }

  /** The time at the handle (s). */
  private get time(): number {
    const time = this.slider.valueAsNumber;
    const { begin, end } = this.timeline ?? { begin: time, end: time };
    const near = 1e-9 * (end - begin); // sliders round, and just before the end the previous frame is shown
    return time - begin <= near ? begin : end - time <= near ? end : time;
  }

  private describe(): void {
    if (!this.timeline) return;
    const { begin, end } = this.timeline;
    const text = recordingTime(this.time, end - begin);
    setText(this.position, text);
    this.slider.setAttribute("aria-valuetext", `${text} of ${recordingTime(end, end - begin)}`);
    const share = end > begin ? (this.time - begin) / (end - begin) : 0;
    this.slider.style.setProperty("--share", String(Math.min(1, Math.max(0, share))));
  }

  /** Left and right arrow: one frame. Up and down: one second, or a tenth of the recording if that is less. */
  private pressed(event: KeyboardEvent): void {
    if (!this.timeline || event.ctrlKey || event.metaKey || event.altKey) return;
    const { begin, end, frames } = this.timeline;
    const frame = (end - begin) / Math.max(1, Number(frames) - 1);
    if (event.key === "ArrowRight" && this.still) {
      event.preventDefault();
      this.newest += frame; // an estimate, until the frame arrives
      this.still = false;
      this.step();
      return;
    }
    // The server seeks to the last frame that is not after the time. Distances between frames may differ, so the
    // previous frame is found by a time slightly before this frame.
    const back = this.still ? 1e-4 * frame : frame;
    const far = Math.min(1, longStep * (end - begin));
    const to: Record<string, number> = {
      ArrowRight: this.newest + frame,
      ArrowLeft: this.newest - back,
      ArrowUp: this.newest + far,
      ArrowDown: this.newest - far,
      PageUp: this.newest + far,
      PageDown: this.newest - far,
      Home: begin,
      End: end,
    };
    const time = to[event.key];
    if (time === undefined) return;
    event.preventDefault();
    this.slider.value = String(time); // between begin and end
    this.describe();
    this.newest = this.time; // for the next key, which may be pressed before the answer arrives
    this.still = false;
    this.seek(this.time, true);
  }
}
