import { h } from "./dom";

export type Tone = "good" | "bad" | "plain";

const stays = { good: 2200, plain: 4000, bad: 7000 }; // ms
export const longStay = 15_000; // ms, for messages that the user may copy
const maxToasts = 3;

interface ToastOptions {
  stay?: number; // ms
  detail?: string; // more for those who want to know exactly; the message stays while it is open
  topic?: string; // the message replaces one with the same topic
  actions?: Record<string, () => void>; // buttons, by their names
}

/** Short messages that disappear by themselves. */
export class Toasts {
  readonly element = h("div", { class: "toasts", "data-testid": "toasts", role: "status", "aria-live": "polite" });

  /** Shows a message unless the same text is visible already. */
  once(title: string, text: string, tone: Tone): void {
    const visible = [...this.element.children].some((toast) => toast.querySelector("span")?.textContent === text);
    if (!visible) this.show(title, text, tone);
  }

  show(title: string, text: string, tone: Tone, options: ToastOptions = {}): void {
    const { stay = stays[tone], detail = "", topic = "", actions = {} } = options;
    if (topic) this.element.querySelector(`[data-topic="${CSS.escape(topic)}"]`)?.remove();
    const toast = h(
      "div",
      { class: `toast ${tone}`, "data-testid": "toast", "data-tone": tone, "data-topic": topic },
      h("strong", {}, title),
      h("span", { "data-testid": "toast-text" }, text),
    );
    const more = h("details", {}, h("summary", {}, "Details"), h("p", { "data-testid": "toast-detail" }, detail));
    if (detail) toast.append(more);
    const buttons = Object.entries(actions).map(([name, click]) =>
      h("button", { type: "button", "data-testid": `toast-${name.toLowerCase()}`, click }, name),
    );
    if (buttons.length > 0) toast.append(h("div", { class: "actions" }, ...buttons));
    toast.addEventListener("click", ({ target }) => {
      if (!(target instanceof Node && more.contains(target))) toast.remove();
    });
    this.element.append(toast);
    while (this.element.childElementCount > maxToasts) this.element.firstElementChild?.remove();
    const leave = (): void => {
      if (more.open) return void setTimeout(leave, stay);
      toast.classList.add("leaving");
      setTimeout(() => toast.remove(), 300);
    };
    setTimeout(leave, stay);
  }
}
