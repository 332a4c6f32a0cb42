/** The effect of a click or a drag on the picture. */
export type Tool = "select" | "push" | "pull" | "drop";
