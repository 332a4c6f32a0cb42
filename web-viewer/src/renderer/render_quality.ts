/** How an image is drawn. */
export interface RenderQuality {
  full: boolean; // with soft shadows, ambient occlusion, outlines and smooth edges
  shadowSize: number; // texels per side
  scale: number; // pixels per CSS pixel, at most
}

const full: RenderQuality = { full: true, shadowSize: 2048, scale: 2 };
const light: RenderQuality = { full: false, shadowSize: 1024, scale: 1 };

/** For pictures that the user saves. */
export const best: RenderQuality = { ...full, shadowSize: 4096 };

/** From the best to the cheapest. */
export const ladder: readonly RenderQuality[] = [
  full,
  { ...full, scale: 1 },
  light,
  { ...light, scale: 0.8 },
  { ...light, scale: 0.6, shadowSize: 512 },
];

const lightRung = 2;

export type RenderQualityChoice = "auto" | "full" | "light";

/**
 * Chooses a rung of the ladder: the user's choice, or in `auto` the best one that draws at about 30 images per second.
 * In `auto` it only goes down.
 */
export class RenderQualityControl {
  private rung: number;
  private slow = 0; // images in excess that took too long
  private seen = 0; // images on this rung

  constructor(
    private choice: RenderQualityChoice,
    private readonly software: boolean,
  ) {
    this.rung = this.start();
  }

  get quality(): RenderQuality {
    return ladder[this.rung] ?? light;
  }

  choose(choice: RenderQualityChoice): void {
    this.choice = choice;
    this.restart();
  }

  /** Starts again at the best rung, for another scene or size. */
  restart(): void {
    this.rung = this.start();
    this.slow = 0;
    this.seen = 0;
  }

  /** Reports the time (ms) from one image to the next during continuous drawing. Returns true if the rung changed. */
  took(elapsed: number): boolean {
    this.seen += 1;
    if (this.choice !== "auto" || this.seen < 5) return false; // the first images include the compilation of shaders
    this.slow = elapsed > 34 ? this.slow + 1 : Math.max(0, this.slow - 2);
    if (this.slow < 12 || this.rung === ladder.length - 1) return false;
    this.rung += 1;
    this.slow = 0;
    this.seen = 0;
    return true;
  }

  private start(): number {
    if (this.choice === "full") return 0;
    return this.choice === "light" || this.software ? lightRung : 0;
  }
}
