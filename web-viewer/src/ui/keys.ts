export interface Key {
  keys: string[]; // as KeyboardEvent.key, letters in lower case
  shown: string;
  says: string;
  act(): void;
}

/** Keys with which a slider that has the focus is moved. */
const slides = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp", "PageDown"];

/** Listens for keys, except while something is being typed. */
export function listenForKeys(keys: () => Key[]): void {
  const pressedDown = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof HTMLElement && keeps(event.target, event.key)) return;
    const pressed = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const key = keys().find((candidate) => candidate.keys.includes(pressed));
    if (!key) return;
    event.preventDefault(); // space would press the button that has the focus
    key.act();
  };
  window.addEventListener("keydown", pressedDown, true); // before the panel, which keeps keys to itself
}

/** Whether the key is for what has the focus. */
function keeps(target: HTMLElement, key: string): boolean {
  if (target.matches("input[type=range]")) return slides.includes(key);
  return target.matches("input, select, textarea") && key !== "Escape";
}
