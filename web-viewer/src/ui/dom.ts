type Child = Node | string;
type Attributes = Record<string, string | boolean | ((event: Event) => void)>;

/** Creates an element with attributes and children. An attribute that is a function becomes an event listener. */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (typeof value === "boolean") element.toggleAttribute(name, value);
    else if (name === "style")
      element.style.cssText = value; // security policies may forbid the attribute
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

let lastId = 0;

/** An id that no other element of the page has, as long as each bundle uses prefixes of its own. */
export function uniqueId(prefix: string): string {
  return `${prefix}-${++lastId}`;
}

/** Creates an icon from a path in 20 x 20 units. */
export function icon(path: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("aria-hidden", "true");
  const line = document.createElementNS(svg.namespaceURI, "path");
  line.setAttribute("d", path);
  svg.append(line);
  return svg;
}

/** Sets the text if it has changed: an unchanged text then costs no layout. */
export function setText(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** Sets the tooltip if it has changed. */
export function setTitle(element: HTMLElement, title: string): void {
  if (element.title !== title) element.title = title;
}

/** Lets the keyboard scroll an element while it has more content than room. */
export function focusWhileScrolling(element: HTMLElement): void {
  new ResizeObserver(() => {
    if (element.scrollHeight > element.clientHeight + 1) element.tabIndex = 0;
    else element.removeAttribute("tabindex");
  }).observe(element);
}
