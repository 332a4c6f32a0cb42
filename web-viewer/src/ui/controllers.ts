import type { Controller } from "lil-gui";
import type GUI from "lil-gui";
import { uniqueId } from "./dom";

/** Marks a controller of the panel for tests, which then do not depend on the panel's markup. */
export function tag<C extends Controller>(id: string, controller: C): C {
  controller.domElement.dataset.control = id;
  controller.domElement.querySelector("input:not([type=range]), select, button")?.setAttribute("data-testid", id);
  return controller;
}

/** Tells assistive software which controls belong together. */
export function nameFolders(gui: GUI): void {
  gui.foldersRecursive().forEach(({ domElement, $title }) => {
    $title.id = uniqueId("folder");
    domElement.setAttribute("role", "group");
    domElement.setAttribute("aria-labelledby", $title.id);
  });
}

/** A set of controllers that are disabled together, with a reason as their tooltip. */
export class Restriction {
  private readonly titles: Map<Controller, string>;

  constructor(controllers: Controller[]) {
    this.titles = new Map(controllers.map((controller) => [controller, controller.domElement.title]));
  }

  /** An empty reason enables them. */
  set(blockedReason: string): void {
    for (const [controller, title] of this.titles) {
      controller.enable(!blockedReason);
      controller.domElement.title = blockedReason || title;
    }
  }
}
