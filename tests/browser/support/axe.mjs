// Checks the accessibility of a page with axe-core, and contrast over the canvas, of which axe-core knows nothing.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const source = await readFile(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];

/** Returns the faults that axe-core finds, as text. */
export async function axeFaults(page) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(source);
  const violations = await page.evaluate(async (values) => {
    const result = await axe.run(document, { runOnly: { type: "tag", values }, resultTypes: ["violations"] });
    return result.violations.map(({ id, help, nodes }) => ({ id, help, targets: nodes.map(({ html }) => html) }));
  }, tags);
  return violations.flatMap(({ id, help, targets }) => targets.map((target) => `${id}: ${help}: ${target}`));
}

/**
 * Returns the visible texts and edges of controls whose contrast with their background is lower than WCAG 2.2 AA
 * demands. `canvas`: colours (0..255) of the canvas behind them.
 */
export function faintParts(page, canvas) {
  return page.evaluate((behind) => {
    const area = Object.assign(document.createElement("canvas"), { width: 1, height: 1 });
    const context = area.getContext("2d", { willReadFrequently: true });
    const parse = (colour) => {
      context.clearRect(0, 0, 1, 1);
      context.fillStyle = colour;
      context.fillRect(0, 0, 1, 1);
      const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
      return [r, g, b, a / 255];
    };
    const over = ([r, g, b, a], under) => [r, g, b].map((part, i) => a * part + (1 - a) * under[i]);
    const luminance = (colour) => {
      const [r, g, b] = colour.map((part) => (part <= 10 ? part / 3294 : ((part / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const contrast = (one, other) => {
      const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
      return (high + 0.05) / (low + 0.05);
    };
    const groundOf = (element, colour) => {
      const chain = [];
      for (let one = element; one && !one.matches(".page"); one = one.parentElement) chain.unshift(one);
      return chain.reduce((under, one) => over(parse(getComputedStyle(one).backgroundColor), under), colour);
    };
    const edgeOf = ({ borderTopWidth, borderTopColor, boxShadow, backgroundColor }) => {
      if (parseFloat(borderTopWidth) > 0) return borderTopColor;
      return /^rgba?\([^)]*\)/.exec(boxShadow)?.[0] ?? backgroundColor;
    };
    const faults = [];
    const check = (what, colour, ground, least) => {
      const found = contrast(over(parse(colour), ground), ground);
      if (found < least) faults.push(`${what}: ${found.toFixed(2)} on ${ground.map(Math.round)}`);
    };
    for (const element of document.querySelectorAll(".page *")) {
      if (!element.checkVisibility() || element.closest(":disabled, .control:has(:disabled), option")) continue;
      const style = getComputedStyle(element);
      const texts = [...element.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE);
      const words = texts.map((node) => node.data.trim()).join("");
      const size = parseFloat(style.fontSize);
      const least = size >= 24 || (size >= 18.66 && style.fontWeight >= 700) ? 3 : 4.5;
      const isField = element.matches("select, .many, input:not([type=range], .many input)");
      const hasEdge = isField && (style.appearance === "none" || element.type !== "checkbox"); // else the browser's own
      for (const colour of element.closest("dialog") ? behind.slice(0, 1) : behind) {
        if (words) check(words.slice(0, 40), style.color, groundOf(element, colour), least);
        const name = element.dataset.testid ?? element.className;
        if (hasEdge) check(`edge of ${name}`, edgeOf(style), groundOf(element.parentElement, colour), 3);
      }
    }
    return faults;
  }, canvas);
}
