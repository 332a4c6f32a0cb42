import { h } from "./dom";
import { concerns } from "./hosts";
import type { Toasts } from "./toasts";

/** Actions that open files, by the endings of their names. */
export type Openers = Record<string, { what: string; open(file: File): void }>;

/** Opens files that the user chooses or drops on the page, and gives files to the user. */
export class Files {
  private readonly field: HTMLInputElement;

  constructor(
    private readonly openers: Openers,
    private readonly toasts: Toasts,
    host: HTMLElement,
    container: HTMLElement,
  ) {
    const accept = Object.keys(openers).join(",");
    const change = (): void => this.open(this.field.files);
    this.field = h("input", { type: "file", accept, hidden: true, "data-testid": "file", change });
    container.append(this.field);
    const over = (event: DragEvent): void => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      if (!concerns(host, event)) return;
      event.preventDefault();
      container.classList.toggle("dropping", event.type === "dragover");
    };
    window.addEventListener("dragover", over);
    window.addEventListener("dragleave", over);
    window.addEventListener("drop", (event) => {
      over(event);
      if (concerns(host, event)) this.open(event.dataTransfer?.files ?? null);
    });
  }

  choose(): void {
    this.field.value = ""; // the same file can be chosen again
    this.field.click();
  }

  /** Saves the file where the browser saves downloads. */
  give(file: Blob, name: string): void {
    const href = URL.createObjectURL(file);
    h("a", { href, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(href), 60_000);
  }

  private open(files: FileList | null): void {
    const [file] = files ?? [];
    if (!file) return;
    const ending = Object.keys(this.openers).find((one) => file.name.toLowerCase().endsWith(one));
    const opener = ending && this.openers[ending];
    if (opener) return opener.open(file);
    const known = Object.entries(this.openers).map(([one, { what }]) => `${what} (${one})`);
    this.toasts.show("Not opened", `${file.name} is of another kind. This page opens ${known.join(" and ")}.`, "bad");
  }
}
