// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden } from "../dom";

/** The user opens files by dropping them anywhere on the page, or by a button. */
export class OpenControls {
  readonly element: HTMLElement;
  readonly #live: HTMLElement;

  /** `open` is given a file; `goLive` ends what is played. */
  constructor(open: (file: File) => void, goLive: () => void) {
    const chosen = element("input", { type: "file", hidden: true, "data-role": "chosen-file" });
    chosen.addEventListener("change", () => {
      for (const file of chosen.files ?? []) open(file);
      chosen.value = "";
    });
    this.#live = button("Back to what is live", goLive, { "data-role": "go-live", hidden: true });
    this.element = element(
      "span",
      { class: "open-controls" },
      button("Open a file", () => chosen.click(), {
        "data-role": "open-file",
        title: "A recording (MCAP, CSV, npy), a model, an array.toml; or drop it anywhere",
      }),
      this.#live,
      chosen,
    );
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      for (const file of event.dataTransfer?.files ?? []) open(file);
    });
  }

  showPlayed(isPlayed: boolean): void {
    setHidden(this.#live, !isPlayed);
  }
}
