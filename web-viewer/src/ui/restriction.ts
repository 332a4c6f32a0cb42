import type { Controller } from "lil-gui";

/** Controls of the panel that are out of use together, and say why. */
export class Restriction {
  private readonly titles: Map<Controller, string>;

  constructor(controllers: Controller[]) {
    this.titles = new Map(controllers.map((controller) => [controller, controller.domElement.title]));
  }

  /** Empty: they are of use. */
  set(why: string): void {
    for (const [controller, title] of this.titles) {
      controller.enable(!why);
      controller.domElement.title = why || title;
    }
  }
}
