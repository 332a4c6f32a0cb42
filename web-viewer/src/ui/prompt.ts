import { h, icon, setText, uniqueId } from "./dom";

const eye = "M2.5 10S5.3 5 10 5s7.5 5 7.5 5-2.8 5-7.5 5-7.5-5-7.5-5zM10 7.8a2.2 2.2 0 1 1 0 4.4 2.2 2.2 0 0 1 0-4.4z";
const struckEye = `${eye}M3.5 16.5l13-13`;

/** A dialog that asks for a token. The field is cleared as soon as the token is submitted. */
export class Prompt {
  private readonly ids = { field: uniqueId("token"), wrong: uniqueId("token") };
  private readonly field = h("input", {
    id: this.ids.field,
    type: "password",
    autocomplete: "off",
    autocapitalize: "off",
    spellcheck: "false",
    "aria-describedby": this.ids.wrong,
    "data-testid": "token-field",
  });
  private readonly reveal = h("button", {
    type: "button",
    class: "reveal",
    "data-testid": "token-reveal",
    click: () => this.show(this.field.type === "password"),
  });
  private readonly message = h("p", {
    id: this.ids.wrong,
    class: "wrong",
    role: "alert",
    "data-testid": "token-wrong",
  });
  private readonly connect = h("button", { type: "submit", class: "primary", "data-testid": "token-connect" });
  readonly element: HTMLDialogElement;

  /** `submit` is given the text of the field. It returns false if the text has no token. */
  constructor(
    host: string,
    private readonly submit: (text: string) => boolean,
  ) {
    const [title, about] = [uniqueId("token"), uniqueId("token")];
    const form = h(
      "form",
      { submit: (event) => this.submitted(event) },
      h("h2", { id: title }, "Token required"),
      h("p", { id: about }, h("b", {}, host), " requires a token."),
      h("label", { for: this.ids.field }, "Token"),
      h("div", { class: "entry" }, this.field, this.reveal),
      this.message,
      h("div", { class: "row" }, h("small", {}, "Kept until this tab is closed."), this.connect),
    );
    const attributes = {
      class: "prompt",
      "data-testid": "token-prompt",
      "aria-labelledby": title,
      "aria-describedby": about,
    };
    this.element = h("dialog", { ...attributes, close: () => this.clear() }, form);
    this.clear();
    this.wait(false);
  }

  /** Opens the dialog. `message`: why the last token was rejected; empty if there was none. */
  ask(message: string): void {
    this.wait(false);
    this.setMessage(message);
    if (!this.element.open) this.element.showModal();
    this.field.focus();
  }

  get open(): boolean {
    return this.element.open;
  }

  close(): void {
    this.wait(false);
    this.setMessage("");
    this.element.close();
  }

  private submitted(event: Event): void {
    event.preventDefault();
    const text = this.field.value;
    this.clear();
    this.setMessage("");
    if (this.submit(text)) this.wait(true);
    else this.ask("The field has no token.");
  }

  private setMessage(message: string): void {
    setText(this.message, message);
    this.field.setAttribute("aria-invalid", String(message !== ""));
  }

  /** Disables the dialog while the server's answer is pending. */
  private wait(waiting: boolean): void {
    this.field.disabled = this.reveal.disabled = this.connect.disabled = waiting;
    setText(this.connect, waiting ? "Connecting…" : "Connect");
  }

  private clear(): void {
    this.field.value = "";
    this.show(false);
  }

  private show(shown: boolean): void {
    this.field.type = shown ? "text" : "password";
    this.reveal.replaceChildren(icon(shown ? struckEye : eye));
    this.reveal.title = shown ? "Hide the token" : "Show the token";
    this.reveal.setAttribute("aria-label", "Show the token");
    this.reveal.setAttribute("aria-pressed", String(shown));
  }
}
