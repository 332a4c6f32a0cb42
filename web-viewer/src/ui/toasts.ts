import { h } from "./dom";

export type Tone = "good" | "bad" | "plain";

const stays = { good: 2200, plain: 4000, bad: 7000 }; // ms
export const longStay = 15_000; // ms, for messages that the user may copy
const maxToasts = 3;

/** Short messages that disappear by themselves. */
export class Toasts {
  readonly element = h("div", { class: "toasts", "data-testid": "toasts", role: "status", "aria-live": "polite" });

  /** Shows a message unless the same text is visible already. */
  once(title: string, text: string, tone: Tone): void {
    const visible = [...this.element.children].some((toast) => toast.lastElementChild?.textContent === text);
    if (!visible) this.show(title, text, tone);
  }

  show(title: string, text: string, tone: Tone, stay: number = stays[tone]): void {
    const toast = h(
      "div",
      { class: `toast ${tone}`, "data-testid": "toast", "data-tone": tone },
      h("strong", {}, title),
      h("span", {}, text),
    );
    toast.addEventListener("click", () => toast.remove());
    this.element.append(toast);
    while (this.element.childElementCount > maxToasts) this.element.firstElementChild?.remove();
    setTimeout(() => {
      toast.classList.add("leaving");
      setTimeout(() => toast.remove(), 300);
    }, stay);
  }
}
