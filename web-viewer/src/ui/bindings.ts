import { effect } from "@preact/signals-core";

type Values<Target> = { [Name in keyof Target]?: () => Target[Name] };

/** Text that follows state: all that `of` reads. */
export function liveText(of: () => string): Text {
  const text = document.createTextNode("");
  effect(() => {
    const next = of();
    if (text.data !== next) text.data = next;
  });
  return text;
}

/**
 * Lets properties of an element, such as `hidden`, follow state. A property that begins with `aria-` or `data-` is an
 * attribute. Returns the element.
 */
export function live<Target extends HTMLElement>(
  element: Target,
  values: Values<Target> & Record<`aria-${string}` | `data-${string}`, () => string>,
): Target {
  for (const [name, of] of Object.entries(values)) follow(element, name, of as () => unknown);
  return element;
}

function follow(element: HTMLElement, name: string, of: () => unknown): void {
  const isAttribute = /^(aria|data)-/.test(name);
  effect(() => {
    const next = of();
    if (isAttribute) element.setAttribute(name, String(next));
    else if (Reflect.get(element, name) !== next) Reflect.set(element, name, next);
  });
}

/** Lets a class of an element follow state. */
export function liveClass(element: HTMLElement, name: string, of: () => boolean): void {
  effect(() => void element.classList.toggle(name, of()));
}
