/** Where a viewer is on the page, and its server. */
export interface Site {
  host: HTMLElement; // everything that belongs to the viewer
  view: HTMLCanvasElement;
  server: URL; // address of the server's page
  own: boolean; // the viewer takes its choices and links from the address of the page, which has the viewer's theme
}

/** The elements of the page in which viewers are. */
const hosts: HTMLElement[] = [];
let pointed: EventTarget | null = null; // the element under the pointer

const hostOf = (target: EventTarget | null): HTMLElement | undefined =>
  hosts.find((host) => target instanceof Node && host.contains(target));

export function addHost(host: HTMLElement): void {
  hosts.push(host);
  if (hosts.length > 1) return;
  window.addEventListener("pointerover", ({ target }) => (pointed = target), { capture: true, passive: true });
}

/**
 * Whether an event is for the viewer in `host`: it happened there, or the pointer is there and the event happened in no
 * viewer. A viewer that is alone on the page gets all events.
 */
export function concerns(host: HTMLElement, { target }: Event): boolean {
  return hosts.length === 1 || (hostOf(target) ?? hostOf(pointed)) === host;
}
