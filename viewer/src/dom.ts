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
