// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

type Attributes = Record<string, string | number | boolean | ((event: Event) => void) | undefined>;

/** An element with attributes ("class", "aria-label", "data-role", ...), listeners ("onclick") and children. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const result = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    if (typeof value === "function") result.addEventListener(name.slice(2), value);
    else result.setAttribute(name, value === true ? "" : String(value));
  }
  result.append(...children);
  return result;
}

function kindOf(thing: string, attributes: Attributes): string {
  return attributes.class === undefined ? thing : `${thing} ${attributes.class}`;
}

/** A button that does something; `attributes.class`: its kind, such as "primary". */
export function button(words: Node | string, onclick: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return element("button", { type: "button", ...attributes, class: kindOf("button", attributes), onclick }, words);
}

/** A framed part of the page. `title`: its words, which also name it, or all that stands in the line of the title. */
export function panel(
  title: string | readonly (Node | string)[],
  attributes: Attributes,
  ...children: (Node | string)[]
): HTMLElement {
  const line = typeof title === "string" ? [element("h2", {}, title)] : title;
  const name = typeof title === "string" ? title : undefined;
  return element(
    "section",
    { "aria-label": name, ...attributes, class: kindOf("panel", attributes) },
    element("header", { class: "panel-title" }, ...line),
    ...children,
  );
}

/** A table under its heads, in a room where it can be scrolled. */
export function table(
  heads: readonly (readonly (Node | string)[] | string)[],
  kind: string,
  body: HTMLElement,
): HTMLElement {
  const head = heads.map((words) => element("th", { scope: "col" }, ...(typeof words === "string" ? [words] : words)));
  return element(
    "div",
    { class: "table-room" },
    element("table", { class: `table ${kind}` }, element("thead", {}, element("tr", {}, ...head)), body),
  );
}

/** Sets the text of an element, touching the page only where it changes. */
export function setText(target: HTMLElement, text: string): void {
  const node = target.firstChild;
  if (node instanceof Text && target.childNodes.length === 1) {
    if (node.data !== text) node.data = text;
  } else {
    target.textContent = text;
  }
}

export function setData(target: HTMLElement, name: string, value: string): void {
  if (target.dataset[name] !== value) target.dataset[name] = value;
}

export function setHidden(target: HTMLElement, hidden: boolean): void {
  if (target.hidden !== hidden) target.hidden = hidden;
}
