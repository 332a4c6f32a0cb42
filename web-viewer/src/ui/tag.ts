import type { Controller } from "lil-gui";

/** Marks a control, so that a test finds it whatever the panel's markup. */
export function tag<C extends Controller>(id: string, controller: C): C {
  controller.domElement.dataset.control = id;
  controller.domElement.querySelector("input:not([type=range]), select, button")?.setAttribute("data-testid", id);
  return controller;
}
