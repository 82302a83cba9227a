// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden } from "../dom";
import { Signal } from "../signal";
import type { Stream } from "../stream/stream";

/** An array that was described or calibrated before, as /array/known has it. */
export interface KnownArray {
  file: string;
  name: string;
  rows: number;
  cols: number;
  calibrated: boolean;
  /** Where it was; empty: not known. */
  from: string;
}

/** The arrays of the server's folder, from last time. */
export class KnownArrays {
  readonly all = new Signal<readonly KnownArray[]>([]);
  /** That one looks for; undefined: it may be a new one. */
  readonly chosen = new Signal<KnownArray | undefined>(undefined);

  constructor(stream: Stream) {
    stream.services.follow((services) => {
      if (services.has("/array/known")) void this.#look(stream);
    });
  }

  /** A button for each, where there is one. */
  makeList(choose: (known: KnownArray) => void): HTMLElement {
    const list = element("div", { class: "port-list" });
    const part = element(
      "div",
      { class: "setup-part", "data-role": "known-arrays", hidden: true },
      element("h3", {}, "From last time"),
      list,
    );
    this.all.follow((all) => {
      list.replaceChildren(...all.map((known) => makeKnown(known, () => choose(known))));
      setHidden(part, all.length === 0);
    });
    this.chosen.follow((chosen) => {
      for (const button of list.children)
        button.setAttribute(
          "aria-pressed",
          String(chosen !== undefined && button.getAttribute("data-known") === chosen.file),
        );
    });
    return part;
  }

  /** "mat", or the first of mat2, mat3, ... that none has. */
  freeName(): string {
    const isTaken = (name: string): boolean => this.all.value.some((known) => known.name === name);
    let name = "mat";
    for (let number = 2; isTaken(name); ++number) name = `mat${number}`;
    return name;
  }

  async #look(stream: Stream): Promise<void> {
    const { arrays } = (await stream.callService("/array/known", {})) as { arrays: KnownArray[] };
    this.all.value = arrays;
  }
}

function makeKnown({ file, name, rows, cols, calibrated, from }: KnownArray, choose: () => void): HTMLElement {
  const words = `${name}, ${rows}\u00d7${cols}, ${calibrated ? "calibrated" : "not calibrated"}`;
  return button(words, choose, {
    "aria-pressed": "false",
    title: from === "" ? file : `${file}, last at ${from}`,
    "data-known": file,
  });
}
