import { recordingTime } from "../format";
import type { Track } from "../model/session";
import { h, icon, setText, setTitle } from "./dom";

const longStep = 0.1; // of the track, at most
const download = "M10 3v9M6 8.5l4 4 4-4M4 16.5h12";

export interface ScrubberActions {
  /** Goes to a time (s). `released`: the user has released the handle. */
  seek(time: number, released: boolean): void;
  /** Goes to the next frame. */
  step(): void;
  /** Shows the present of the simulation. */
  present(): void;
  /** Saves the track of a simulation as a file. */
  save(): void;
}

/** A timeline: the present position, and a handle to seek. */
export class Scrubber {
  private readonly slider = h("input", { type: "range", step: "any", "data-testid": "timeline" });
  private readonly position = h("b", { "data-testid": "timeline-position" });
  private readonly file = h("span", { class: "file", "data-testid": "timeline-file" });
  private readonly range = h("span", { "data-testid": "timeline-range" });
  private readonly flaw = h("p", { class: "flaw", "data-testid": "timeline-flaw" });
  private readonly live: HTMLButtonElement;
  private readonly save: HTMLButtonElement;
  readonly element: HTMLElement;
  private track: Track | undefined;
  private newest = 0; // s: of the newest state, or the target of a seek; the handle moves towards it
  private still = false; // paused, and no seek is in progress
  private held = false; // the user holds the handle: no state moves it
  private atEnd = false; // the handle was dragged to the end, which may have moved on since then

  constructor(private readonly actions: ScrubberActions) {
    const { slider } = this;
    const button = (id: string, click: () => void, ...children: Node[]): HTMLButtonElement =>
      h("button", { type: "button", class: id, "data-testid": id, click }, ...children);
    this.live = button("present", () => actions.present());
    this.save = button("save", () => actions.save(), icon(download));
    const reading = h("div", { class: "reading" }, this.position, this.file, this.range);
    const buttons = h("div", { class: "buttons" }, this.live, this.save);
    const attributes = { class: "timeline", hidden: true, "aria-label": "Timeline" };
    this.element = h("section", attributes, reading, slider, buttons, this.flaw);
    slider.addEventListener("pointerdown", () => (this.held = true));
    slider.addEventListener("input", () => {
      this.describe();
      this.go(false);
    });
    slider.addEventListener("change", () => this.go(true));
    for (const end of ["pointerup", "pointercancel", "change", "blur"]) {
      slider.addEventListener(end, () => (this.held = false));
    }
    slider.addEventListener("keydown", (event) => this.pressed(event));
  }

  /** Returns true if it is another recording, or another kind of track, than before. */
  setTrack(track: Track | undefined): boolean {
    const before = this.track;
    this.track = track;
    this.element.hidden = !track;
    if (!track) return before !== undefined;
    const { begin, end, file, flaw, frames, live } = track;
    this.slider.min = String(begin);
    this.slider.max = String(end);
    if (live && before?.live) return false;
    const parts = (one: Track | undefined): unknown => one && [one.begin, one.end, one.file, one.flaw, one.frames];
    if (String(parts(track)) === String(parts(before))) return false;
    this.held = false;
    this.element.classList.toggle("of-simulation", live);
    this.slider.setAttribute("aria-label", live ? "Position in the last seconds" : "Position in the recording");
    setText(this.file, file);
    this.file.title = live ? "" : `${file}, ${frames} frames`;
    const last = recordingTime(end, end - begin);
    setText(this.range, begin === 0 ? last : `${recordingTime(begin, end - begin)} – ${last}`);
    setText(this.flaw, flaw && `Ends early: ${flaw}`);
    this.flaw.hidden = !flaw;
    this.element.title = flaw ? `The recording is incomplete: ${flaw}` : "";
    return true;
  }

  /** `replay`: the page shows the past of a simulation, or a file; not what a server sends at present. */
  setReplay(replay: boolean): void {
    const { live = false, begin = 0, end = 0 } = this.track ?? {};
    this.element.classList.toggle("replay", live && replay);
    this.live.hidden = !live && !replay;
    setText(this.live, live ? "Live" : "Back to live");
    this.live.disabled = !replay;
    setTitle(this.live, replay ? "Show the simulation as it is now (End)" : "The picture is live");
    this.save.hidden = !live;
    const name = `Save the last ${Math.round(end - begin)} s as a recording`;
    setTitle(this.save, name);
    this.save.setAttribute("aria-label", name);
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
    const { begin, end } = this.track ?? { begin: time, end: time };
    const near = 1e-9 * (end - begin); // sliders round, and just before the end the previous frame is shown
    return time - begin <= near ? begin : end - time <= near ? end : time;
  }

  private describe(): void {
    if (!this.track) return;
    const { begin, end, live } = this.track;
    const ago = (end - this.time).toFixed(1);
    const text = live ? (ago === "0.0" ? "live" : `−${ago} s`) : recordingTime(this.time, end - begin);
    setText(this.position, text);
    const spoken = live ? (ago === "0.0" ? "live" : `${ago} s ago`) : `${text} of ${recordingTime(end, end - begin)}`;
    this.slider.setAttribute("aria-valuetext", spoken);
    const share = end > begin ? (this.time - begin) / (end - begin) : 0;
    this.slider.style.setProperty("--share", String(Math.min(1, Math.max(0, share))));
  }

  /** Left and right arrow: one frame. Up and down: one second, or a tenth of the track if that is less. */
  private pressed(event: KeyboardEvent): void {
    if (!this.track || event.ctrlKey || event.metaKey || event.altKey) return;
    const { begin, end, frames } = this.track;
    const frame = (end - begin) / Math.max(1, frames - 1);
    if (event.key === "ArrowRight" && this.still) {
      event.preventDefault();
      this.newest += frame; // an estimate, until the frame arrives
      this.still = false;
      this.actions.step();
      return;
    }
    // A seek goes to the last frame that is not after the time. Distances between frames may differ, so the previous
    // frame is found by a time slightly before this frame.
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
    this.go(true);
  }

  /** Goes to the time at the handle. */
  private go(released: boolean): void {
    const { time, track, actions } = this;
    const isEnd = time >= (track?.end ?? Infinity) || (released && this.atEnd);
    this.atEnd = isEnd && !released;
    if (track?.live && isEnd) actions.present();
    else actions.seek(time, released);
  }
}
