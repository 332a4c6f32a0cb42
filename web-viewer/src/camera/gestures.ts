/** Actions of mouse and touch on the canvas; lengths in CSS pixels. */
export interface Gestures {
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  zoom(factor: number, x: number, y: number): void;
  click(x: number, y: number): void;
  grab(x: number, y: number): boolean; // whether the drag that begins here moves something else than the view
  drag(x: number, y: number): void; // while something is grabbed
  letGo(): void;
}

interface Finger {
  x: number;
  y: number;
}

const slack = 6; // px by which the pointer may move during a click
const wheelLine = 16; // px per line, for wheels that count lines

/**
 * Mouse: drag to orbit; right, middle or shift-drag to pan; wheel to zoom. Touch: one finger to orbit, two to pan and
 * zoom.
 */
export function listen(element: HTMLElement, gestures: Gestures): void {
  const fingers = new Map<number, Finger>();
  let pans = false;
  let moved = 0; // px
  let several = false;
  let grabs = false;
  const letGo = (): void => {
    if (grabs) gestures.letGo();
    grabs = false;
  };

  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    if (fingers.size === 0) {
      moved = 0;
      several = false;
    }
    fingers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    several ||= fingers.size > 1;
    letGo();
    grabs = !several && event.button === 0 && !event.shiftKey && gestures.grab(event.offsetX, event.offsetY);
    pans = event.button === 1 || event.button === 2 || event.shiftKey;
    element.focus({ preventScroll: true });
  });

  element.addEventListener("pointermove", (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return;
    const before = spread([...fingers.values()]);
    const [dx, dy] = [event.offsetX - finger.x, event.offsetY - finger.y];
    finger.x = event.offsetX;
    finger.y = event.offsetY;
    moved += Math.hypot(dx, dy);
    if (fingers.size > 1) {
      const after = spread([...fingers.values()]);
      gestures.pan(after.x - before.x, after.y - before.y);
      if (before.size > 0 && after.size > 0) gestures.zoom(before.size / after.size, after.x, after.y);
    } else if (moved > slack) {
      if (grabs) gestures.drag(finger.x, finger.y);
      else if (pans) gestures.pan(dx, dy);
      else gestures.orbit(dx, dy);
    }
  });

  const lift = (event: PointerEvent): void => {
    if (!fingers.delete(event.pointerId)) return;
    letGo();
    const clicked = event.type === "pointerup" && event.button === 0 && moved <= slack && !several;
    if (clicked) gestures.click(event.offsetX, event.offsetY);
  };
  element.addEventListener("pointerup", lift);
  element.addEventListener("pointercancel", lift);

  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? wheelLine : 1);
      gestures.zoom(Math.exp(Math.min(240, Math.max(-240, pixels)) * 0.0016), event.offsetX, event.offsetY);
    },
    { passive: false },
  );
  element.addEventListener("contextmenu", (event) => event.preventDefault());
}

/** The middle of the first two fingers, and their distance as `size`. */
function spread(fingers: Finger[]): { x: number; y: number; size: number } {
  const [a, b] = fingers;
  if (!a) return { x: 0, y: 0, size: 0 };
  if (!b) return { x: a.x, y: a.y, size: 0 };
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y) };
}
