import { h } from "./dom";

/** `warning`: says why the value stands out. */
export type Row = [id: string, name: string, value: string, warning?: string, title?: string];

/** Shows the rows in a table; each value is found by its test id. */
export function fill(table: HTMLElement, prefix: string, rows: Row[]): void {
  table.hidden = false;
  table.replaceChildren(...rows.map((row) => rowOf(prefix, row)));
}

function rowOf(prefix: string, [id, name, value, warning, title]: Row): HTMLElement {
  const figures = h("td", { class: warning ? "warning" : "", title: warning ?? "", "data-testid": `${prefix}-${id}` }, value);
  return h("tr", { title: title ?? "" }, h("th", {}, name), figures);
}
