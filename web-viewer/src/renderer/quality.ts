/** How a picture is made; the ladder goes from the best to the cheapest. */
export interface Quality {
  samples: number; // per pixel, for smooth outlines
  occlusion: boolean; // darkening where spheres meet
  shadowSize: number; // texels a side
  softShadow: boolean;
  scale: number; // pixels per CSS pixel at most
}

const full: Quality = { samples: 4, occlusion: true, shadowSize: 2048, softShadow: true, scale: 2 };
const light: Quality = { samples: 0, occlusion: false, shadowSize: 1024, softShadow: false, scale: 1 };

export const ladder: readonly Quality[] = [
  full,
  { ...full, scale: 1 },
  light,
  { ...light, scale: 0.8 },
  { ...light, scale: 0.6, shadowSize: 512 },
];

const lightRung = 2;

export type QualityChoice = "auto" | "full" | "light";

/** Picks a rung: the one asked for, or in `auto` the best that keeps the picture fluent. Goes down only, by itself. */
export class QualityControl {
  private rung: number;
  private slow = 0;
  private seen = 0;

  constructor(
    private choice: QualityChoice,
    private readonly software: boolean,
  ) {
    this.rung = this.start();
  }

  get quality(): Quality {
    return ladder[this.rung] ?? light;
  }

  choose(choice: QualityChoice): void {
    this.choice = choice;
    this.restart();
  }

  /** Forgets what was slow, for another scene or size. */
  restart(): void {
    this.rung = this.start();
    this.slow = 0;
    this.seen = 0;
  }

  /** A picture took this long, from one to the next while things moved; ms. True when the rung changed. */
  took(elapsed: number): boolean {
    this.seen += 1;
    if (this.choice !== "auto" || this.seen < 5) return false; // the first pictures compile shaders
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
