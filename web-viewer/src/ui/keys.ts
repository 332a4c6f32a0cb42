export interface Key {
  keys: string[]; // as KeyboardEvent.key, letters in lower case
  shown: string;
  says: string;
  act(): void;
}

/** Listens for keys, except while something is being typed. */
export function listenForKeys(keys: Key[]): void {
  const pressedDown = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typed = event.target instanceof HTMLElement && event.target.matches("input, select, textarea");
    if (typed && event.key !== "Escape") return;
    const pressed = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const key = keys.find((candidate) => candidate.keys.includes(pressed));
    if (!key) return;
    event.preventDefault(); // space would press the button that has the focus
    key.act();
  };
  window.addEventListener("keydown", pressedDown, true); // before the panel, which keeps keys to itself
}
