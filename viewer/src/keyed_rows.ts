// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

export interface Row<Item> {
  readonly element: HTMLElement;
  /** Without it, what the row shows does not change. */
  show?(item: Item): void;
}

/** The rows of a list: one for each key, which stays while its key does. */
export class KeyedRows<Item> {
  readonly #list: HTMLElement;
  readonly #keyOf: (item: Item) => string;
  readonly #make: (item: Item) => Row<Item>;
  readonly #before: readonly Element[];
  #rows = new Map<string, Row<Item>>();

  /** Other children of the list stay before the rows. */
  constructor(list: HTMLElement, keyOf: (item: Item) => string, make: (item: Item) => Row<Item>) {
    this.#list = list;
    this.#before = [...list.children];
    this.#keyOf = keyOf;
    this.#make = make;
  }

  show(items: readonly Item[]): void {
    const before = this.#rows;
    this.#rows = new Map(items.map((item) => [this.#keyOf(item), before.get(this.#keyOf(item)) ?? this.#make(item)]));
    const rows = [...this.#rows.values()];
    const first = this.#before.length;
    const isSame =
      rows.length === before.size && rows.every(({ element }, at) => this.#list.children[first + at] === element);
    if (!isSame) this.#list.replaceChildren(...this.#before, ...rows.map(({ element }) => element));
    for (const item of items) this.#rows.get(this.#keyOf(item))!.show?.(item);
  }
}
