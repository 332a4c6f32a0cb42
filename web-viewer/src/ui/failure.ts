import { h } from "./dom";

/**
 * Shows that the page itself failed, with what to do. `fatal`: it cannot be used; else the user may go on with a page
 * that may be wrong. Shows only the first failure.
 */
export function showFailure(error: unknown, fatal: boolean): void {
  if (document.querySelector("dialog.failure")) return;
  const message = error instanceof Error ? (error.stack ?? error.message) : String(error);
  const dialog = h(
    "dialog",
    { class: "failure", "data-testid": "failure", "aria-labelledby": "failure-title" },
    h("h2", { id: "failure-title" }, fatal ? "This page could not start" : "This page has failed"),
    h("p", {}, `${fatal ? "" : "What it shows may be old or wrong. "}Reload it. The simulation is not affected.`),
    h("details", {}, h("summary", {}, "Details"), h("pre", { "data-testid": "failure-details" }, message)),
  );
  const row = h("div", { class: "row" });
  if (!fatal) row.append(h("button", { type: "button", click: () => dialog.close() }, "Continue"));
  const attributes = { type: "button", class: "primary", autofocus: true, "data-testid": "failure-reload" };
  row.append(h("button", { ...attributes, click: () => location.reload() }, "Reload"));
  dialog.append(row);
  if (fatal) dialog.addEventListener("cancel", (event) => event.preventDefault());
  (document.querySelector(".spherule") ?? document.body).append(dialog); // it has the styles of viewers
  dialog.showModal();
}

/** Shows errors that no other part of the page handles. */
export function watchForFailures(): void {
  // Messages without an error come from the browser itself, and tell of nothing that failed.
  window.addEventListener("error", ({ error }) => {
    if (error) showFailure(error, false);
  });
  window.addEventListener("unhandledrejection", ({ reason }) => showFailure(reason, false));
}
