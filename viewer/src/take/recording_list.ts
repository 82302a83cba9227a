// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import type { Stream } from "../stream/stream";
import { sizeText } from "./save_file";

/** A recording in the server's folder, as /recordings/list has it. */
interface RecordingFile {
  name: string;
  bytes: number;
  changed_s: number;
}

interface Listed {
  folder: string;
  /** The one that is being written, or "". */
  recording: string;
  files: RecordingFile[];
}

/** Where a file of the server is. */
export function fileAddress(stream: Stream, name: string): string {
  const query = stream.token === "" ? "" : `?${new URLSearchParams({ token: stream.token })}`;
  return new URL(`recordings/${encodeURIComponent(name)}${query}`, window.location.href).href;
}

/** The recordings of the server's folder: their size as it grows, to play and to save. */
export class RecordingList {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #tell: (words: string) => void;
  readonly #folder = element("p", { class: "dim" });
  readonly #rows = element("tbody");
  #shown = "";

  constructor(stream: Stream, tell: (words: string) => void) {
    this.#stream = stream;
    this.#tell = tell;
    this.element = element(
      "div",
      { class: "recording-list" },
      this.#folder,
      element("table", { class: "table", "data-role": "recordings" }, this.#rows),
    );
  }

  async refresh(): Promise<void> {
    const listed = (await this.#stream.callService("/recordings/list", {})) as Listed;
    setText(this.#folder, `Folder of the server: ${listed.folder}`);
    const shown = JSON.stringify(listed);
    if (shown === this.#shown) return;
    const names = listed.files.map(({ name }) => name).join("/");
    const isSameList = names === this.#rows.dataset.names;
    this.#shown = shown;
    this.#rows.dataset.names = names;
    if (!isSameList) this.#rows.replaceChildren(...listed.files.map((file) => this.#row(file)));
    listed.files.forEach((file, index) => this.#update(this.#rows.rows[index]!, file, file.name === listed.recording));
  }

  #row({ name }: RecordingFile): HTMLTableRowElement {
    return element(
      "tr",
      { "data-recording": name },
      element("th", { scope: "row" }, name),
      element("td", { class: "figure", "data-field": "size" }),
      element("td", { class: "figure dim", "data-field": "changed" }),
      element(
        "td",
        {},
        element(
          "button",
          { class: "button", type: "button", "data-act": "play", onclick: () => void this.#play(name) },
          "Play it",
        ),
      ),
      element(
        "td",
        {},
        element(
          "a",
          { class: "button", href: fileAddress(this.#stream, name), download: name, "data-act": "download" },
          "Save",
        ),
      ),
    );
  }

  #update(row: HTMLTableRowElement, { bytes, changed_s }: RecordingFile, isWritten: boolean): void {
    const part = (selector: string): HTMLElement => row.querySelector<HTMLElement>(selector)!;
    setText(part("[data-field=size]"), sizeText(bytes));
    setText(
      part("[data-field=changed]"),
      isWritten ? "is being recorded" : new Date(1000 * changed_s).toLocaleString(),
    );
    setHidden(part("[data-act=play]"), isWritten || !this.#stream.services.value.has("/recordings/play"));
    setHidden(part("[data-act=download]"), isWritten);
  }

  /** In a page of its own, while this one shows what is live. */
  async #play(name: string): Promise<void> {
    try {
      const { port } = (await this.#stream.callService("/recordings/play", { name })) as { port: number };
      const address = new URL(window.location.href);
      address.port = String(port);
      address.hash = "";
      if (window.open(address.href, "_blank") === null) this.#tell(`${name} is played at ${address.href}`);
    } catch (error) {
      this.#tell(error instanceof Error ? error.message : String(error));
    }
  }
}
