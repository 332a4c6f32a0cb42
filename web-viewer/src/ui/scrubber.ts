import type { Timeline } from "../gen/spherule/v1/control_pb";
import { h, setText } from "./dom";
import { moment } from "./moment";

const tenth = 0.1; // of the whole, at most, for a long step

/** Where the recording stands, and a handle to take it elsewhere. */
export class Scrubber {
  private readonly slider = h("input", {
    type: "range",
    step: "any",
    "data-testid": "timeline",
    "aria-label": "Moment of the recording",
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
  private stands = 0; // s: of the newest state, or what is on its way; the handle glides there
  private still = false; // it is shown, and nothing goes on by itself
  private held = false; // by hand: what the server says meanwhile does not move it

  /** `wished`: the person wants this moment, s; `last`: the hand has let go; `stepped`: the next frame. */
  constructor(
    private readonly wished: (time: number, last: boolean) => void,
    private readonly stepped: () => void,
  ) {
    this.slider.addEventListener("pointerdown", () => (this.held = true));
    this.slider.addEventListener("input", () => {
      this.describe();
      wished(this.time, false);
    });
    this.slider.addEventListener("change", () => wished(this.time, true));
    for (const end of ["pointerup", "pointercancel", "change", "blur"]) this.slider.addEventListener(end, () => (this.held = false));
    this.slider.addEventListener("keydown", (event) => this.pressed(event));
  }

  /** Returns whether it is another one. */
  offer(timeline: Timeline | undefined): boolean {
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
    setText(this.range, begin === 0 ? moment(end, end) : `${moment(begin, end - begin)} – ${moment(end, end - begin)}`);
    setText(this.flaw, flaw && `Ends early: ${flaw}`);
    this.flaw.hidden = !flaw;
    this.element.title = flaw ? `The recording ends before it was meant to: ${flaw}` : "";
  }

  /** `time`: what the picture shows; `stands`: the newest state, or what is on its way; s. `still`: it stays there. */
  update(time: number | undefined, stands: number | undefined, still: boolean): void {
    this.stands = stands ?? this.stands;
    this.still = still;
    if (time === undefined || this.held) return;
    this.slider.value = String(time);
    this.describe();
  }

  /** `why`: the handle is out of use; empty: that says itself. */
  enable(usable: boolean, why: string): void {
    this.slider.disabled = !usable;
    this.slider.title = why;
    if (!usable) this.held = false; // nobody will say that it was let go
  }

  /** s; what the handle says. */
  get time(): number {
    const time = this.slider.valueAsNumber;
    const { begin, end } = this.timeline ?? { begin: time, end: time };
    const near = 1e-9 * (end - begin); // sliders round, and just before the end another frame is shown
    return time - begin <= near ? begin : end - time <= near ? end : time;
  }

  private describe(): void {
    if (!this.timeline) return;
    const { begin, end } = this.timeline;
    const words = moment(this.time, end - begin);
    setText(this.position, words);
    this.slider.setAttribute("aria-valuetext", `${words} of ${moment(end, end - begin)}`);
    const share = end > begin ? (this.time - begin) / (end - begin) : 0;
    this.slider.style.setProperty("--share", String(Math.min(1, Math.max(0, share))));
  }

  /** A frame with the arrows to the sides, a second or a tenth of the whole with those up and down. */
  private pressed(event: KeyboardEvent): void {
    if (!this.timeline || event.ctrlKey || event.metaKey || event.altKey) return;
    const { begin, end, frames } = this.timeline;
    const frame = (end - begin) / Math.max(1, Number(frames) - 1);
    if (event.key === "ArrowRight" && this.still) {
      event.preventDefault();
      this.stands += frame; // about: until it is there
      this.still = false;
      this.stepped();
      return;
    }
    // The server goes to the last frame that is not after the time. Frames need not be equally far from each other: a little
    // before this one is the one before, wherever that is.
    const back = this.still ? 1e-4 * frame : frame;
    const far = Math.min(1, tenth * (end - begin));
    const to: Record<string, number> = {
      ArrowRight: this.stands + frame,
      ArrowLeft: this.stands - back,
      ArrowUp: this.stands + far,
      ArrowDown: this.stands - far,
      PageUp: this.stands + far,
      PageDown: this.stands - far,
      Home: begin,
      End: end,
    };
    const time = to[event.key];
    if (time === undefined) return;
    event.preventDefault();
    this.slider.value = String(time); // between begin and end
    this.describe();
    this.stands = this.time; // for the next key, which may come before an answer
    this.still = false;
    this.wished(this.time, true);
  }
}
