import { h } from "./dom";

export type Tone = "good" | "bad" | "plain";

const stays = { good: 2200, plain: 4000, bad: 7000 }; // ms
export const longStay = 15_000; // ms, for what is to be copied
const most = 3;

/** Short messages that go away by themselves. */
export class Toasts {
  readonly element = h("div", { class: "toasts", "data-testid": "toasts", role: "status", "aria-live": "polite" });

  show(title: string, text: string, tone: Tone, stay: number = stays[tone]): void {
    const toast = h(
      "div",
      { class: `toast ${tone}`, "data-testid": "toast", "data-tone": tone },
      h("strong", {}, title),
      h("span", {}, text),
    );
    toast.addEventListener("click", () => toast.remove());
    this.element.append(toast);
    while (this.element.childElementCount > most) this.element.firstElementChild?.remove();
    setTimeout(() => {
      toast.classList.add("leaving");
      setTimeout(() => toast.remove(), 300);
    }, stay);
  }
}
