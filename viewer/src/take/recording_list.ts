// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import { dayAndTime, errorText } from "../format";
import { KeyedRows, type Row } from "../keyed_rows";
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

/** Saves a file of the folder. */
export function saveRecorded(stream: Stream, name: string): Promise<void> {
  return stream.save(`recordings/${encodeURIComponent(name)}`, name);
}

interface Entry extends RecordingFile {
  isWritten: boolean;
  isPlayable: boolean;
}

class RecordingRow implements Row<Entry> {
  readonly element: HTMLElement;
  readonly #size = element("td", { class: "figure", "data-field": "size" });
  readonly #changed = element("td", { class: "figure dim", "data-field": "changed" });
  readonly #play: HTMLElement;
  readonly #save: HTMLElement;

  constructor({ name }: Entry, save: () => void, play: () => void) {
    this.#play = button("Play it", play, { "data-act": "play" });
    this.#save = button("Save", save, { "data-act": "download" });
    this.element = element(
      "tr",
      { "data-recording": name },
      element("th", { scope: "row" }, name),
      this.#size,
      this.#changed,
      element("td", {}, this.#play),
      element("td", {}, this.#save),
    );
  }

  show({ bytes, changed_s, isWritten, isPlayable }: Entry): void {
    setText(this.#size, sizeText(bytes));
    setText(this.#changed, isWritten ? "is being recorded" : dayAndTime(changed_s));
    setHidden(this.#play, isWritten || !isPlayable);
    setHidden(this.#save, isWritten);
  }
}

/** The recordings of the server's folder: their size as it grows, to play and to save. */
export class RecordingList {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #tell: (words: string) => void;
  readonly #folder = element("p", { class: "dim" });
  readonly #body = element("tbody");
  readonly #rows = new KeyedRows<Entry>(
    this.#body,
    ({ name }) => name,
    (entry) =>
      new RecordingRow(
        entry,
        () => void this.#try(() => saveRecorded(this.#stream, entry.name)),
        () => void this.#try(() => this.#play(entry.name)),
      ),
  );

  constructor(stream: Stream, tell: (words: string) => void) {
    this.#stream = stream;
    this.#tell = tell;
    this.element = element(
      "div",
      { class: "recording-list" },
      this.#folder,
      element("table", { class: "table", "data-role": "recordings" }, this.#body),
    );
  }

  async refresh(): Promise<void> {
    const listed = (await this.#stream.callService("/recordings/list", {})) as Listed;
    setText(this.#folder, `Folder: ${listed.folder}`);
    const isPlayable = this.#stream.services.value.has("/recordings/play");
    const entries = listed.files.map((file) => ({ ...file, isWritten: file.name === listed.recording, isPlayable }));
    this.#rows.show(entries);
  }

  /** In a page of its own, while this one shows what is live. */
  async #play(name: string): Promise<void> {
    const { port } = (await this.#stream.callService("/recordings/play", { name })) as { port: number };
    if (port === 0) return; // it is played in the place of what is live
    const address = new URL(window.location.href);
    address.port = String(port);
    address.hash = "";
    if (window.open(address.href, "_blank") === null) this.#tell(`${name} is played at ${address.href}`);
  }

  async #try(act: () => Promise<void>): Promise<void> {
    try {
      await act();
    } catch (error) {
      this.#tell(errorText(error));
    }
  }
}
