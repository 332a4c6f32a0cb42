import { json } from "@codemirror/lang-json";
import { HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { basicSetup } from "codemirror";
import { sentence } from "../format";
import { h, setText } from "../ui/dom";
import type { Editor as LazyEditor, Stage } from "../ui/lazy";
import { adoptStyle } from "../ui/parts";
import { refusalText } from "../ui/refusals";
import style from "./editor.css";
import { placeOf, readScene } from "./scene_text";
import type { Fault } from "./scene_text";

const mostText = 4_000_000; // characters that the editor takes

const example = `{
  "name": "mine",
  "bounds": { "min": [-1, -1, 0], "max": [1, 1, 2] },
  "groups": [
    {
      "name": "spheres",
      "fill": { "min": [-1, -1, 1], "max": [1, 1, 2], "count": 200 },
      "radius": { "constant": 0.05 }
    }
  ]
}
`;

/** The colours of the page's theme. */
const theme = EditorView.theme({
  "&": { height: "100%", color: "var(--text)", backgroundColor: "var(--raised)" },
  "&.cm-focused": { outline: "2px solid var(--accent)" },
  ".cm-content": { caretColor: "var(--text)", fontFamily: "ui-monospace, monospace", fontSize: "13px" },
  ".cm-cursor": { borderLeftColor: "var(--text)" },
  ".cm-gutters": { color: "var(--quiet)", backgroundColor: "var(--paper-solid)", borderColor: "var(--line)" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "var(--well)" },
  "&.cm-focused .cm-selectionBackground, .cm-selectionBackground, ::selection": {
    backgroundColor: "var(--accent-soft) !important",
  },
  ".cm-panels, .cm-tooltip": { color: "var(--text)", backgroundColor: "var(--paper-solid)" },
});
const colours = HighlightStyle.define([
  { tag: tags.propertyName, color: "var(--accent)" },
  { tag: [tags.string, tags.number, tags.bool, tags.null], color: "var(--good)" },
]);

/** See ui/lazy.ts. */
export class Editor implements LazyEditor {
  private readonly host = h("div", { class: "text" });
  private readonly message = h("p", { class: "message", role: "alert", "data-testid": "editor-message" });
  private readonly load: HTMLButtonElement;
  private readonly element: HTMLDialogElement;
  private readonly view: EditorView;

  constructor(private readonly stage: Stage) {
    adoptStyle(style);
    // The security policy forbids style elements. In a shadow root, the editor uses style sheets of its own.
    const root = this.host.attachShadow({ mode: "open" });
    const label = EditorView.contentAttributes.of({ "aria-label": "Scene, as JSON" });
    const look = [theme, syntaxHighlighting(colours), EditorView.lineWrapping, lintGutter()];
    const extensions = [basicSetup, json(), look, label];
    this.view = new EditorView({ root, parent: root, state: EditorState.create({ doc: example, extensions }) });
    this.view.scrollDOM.tabIndex = 0; // arrow keys scroll it
    const button = { type: "button", class: "primary", "data-testid": "editor-load", click: () => void this.submit() };
    this.load = h("button", button, "Load");
    const close = { type: "button", "data-testid": "editor-close", click: () => this.element.close() };
    this.element = h(
      "dialog",
      { class: "scene-editor", "aria-label": "Scene", "data-testid": "editor" },
      h("h2", {}, "Scene"),
      this.host,
      this.message,
      h("div", { class: "row" }, h("button", close, "Close"), this.load),
    );
    stage.container.append(this.element);
  }

  get shown(): boolean {
    return this.element.open;
  }

  async open(text?: string): Promise<void> {
    if (text === undefined) return this.show();
    if (text.length > mostText) {
      const hint = "Start the server with it: spherule serve FILE.";
      return this.stage.toasts.show("Not loaded", `The scene file is too large for a page. ${hint}`, "bad");
    }
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
    if (!(await this.submit())) this.show();
  }

  private show(): void {
    if (!this.element.open) this.element.showModal();
    this.view.focus();
  }

  /** Returns false if the scene was not loaded. */
  private async submit(): Promise<boolean> {
    const text = this.view.state.doc.toString();
    const { scene, faults } = readScene(text);
    this.mark(faults);
    if (!scene) return false;
    this.load.disabled = true;
    const outcome = await this.stage.commands.loadScene(`Scene ${scene.name || "from a file"}`, scene);
    this.load.disabled = false;
    if (outcome.case === "applied") {
      this.element.close();
      return true;
    }
    if (outcome.case !== "refused") this.say("Not loaded. The scene that runs goes on.");
    else this.mark([{ ...placeOf(text, outcome.value.field), message: sentence(refusalText(outcome.value)) }]);
    return false;
  }

  private mark(faults: Fault[]): void {
    const { state } = this.view;
    const diagnostics = faults.map((fault) => ({ ...fault, severity: "error" as const }));
    this.view.dispatch(setDiagnostics(state, diagnostics));
    const [first] = faults;
    if (!first) return this.say("");
    this.view.dispatch({ selection: { anchor: first.from }, scrollIntoView: true });
    this.say(`Line ${state.doc.lineAt(first.from).number}: ${first.message}`);
  }

  private say(text: string): void {
    setText(this.message, text);
  }
}
