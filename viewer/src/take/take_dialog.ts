// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setText } from "../dom";
import { errorText } from "../format";
import type { ArrayDescription } from "../suit";
import type { ViewContext } from "../view";
import { type Picture, takeFilm, takePicture } from "./pictures";
import { RecordingList, saveRecorded } from "./recording_list";
import { nameWithTime, saveBlob } from "./save_file";
import "./take.css";

const REFRESH_MS = 1000;
const FILM_S = 4;
const LENGTHS_S = [5, 10, 30, 60];
const FIRST_LENGTH_S = 10;

/** The data that a user can save: recordings, the last minute, pictures. */
export class TakeDialog {
  readonly element: HTMLDialogElement;
  readonly #context: ViewContext;
  readonly #words = element("p", { role: "status", "data-role": "take-words" });
  readonly #name = element("input", {
    id: "recording-name",
    class: "field",
    pattern: "[A-Za-z0-9_\\-]+",
    maxlength: 60,
    placeholder: "walk-1",
    autocomplete: "off",
  });
  readonly #record = button("", () => void this.#try(() => this.#switchRecording()), {
    "data-role": "begin-recording",
  });
  readonly #length: HTMLSelectElement;
  readonly #list: RecordingList;
  #timer = 0;
  /** The time that the page shows while it is paused. */
  #pausedAtS: number | undefined;

  constructor(context: ViewContext) {
    this.#context = context;
    this.#list = new RecordingList(context.stream, (words) => setText(this.#words, words));
    this.#length = element(
      "select",
      { id: "minute-length", class: "field", "data-role": "minute-length" },
      ...LENGTHS_S.map((seconds) =>
        element("option", { value: seconds, selected: seconds === FIRST_LENGTH_S }, `${seconds} s`),
      ),
    );
    this.element = element(
      "dialog",
      { class: "dialog take-dialog", "aria-label": "Record and save", "data-role": "take" },
      element("h2", {}, "Record and save"),
      this.#words,
      element("h3", {}, "Recordings"),
      element("div", { class: "take-row" }, element("label", { for: this.#name.id }, "Name"), this.#name, this.#record),
      this.#list.element,
      element("h3", {}, "The last minute"),
      element(
        "div",
        { class: "take-row" },
        element("label", { for: this.#length.id }, "The last"),
        this.#length,
        this.#button("save-mcap", "Recording (MCAP)", () => this.#saveMinute({})),
        this.#button("save-csv", "Table of this array (CSV)", () => this.#saveMinute({ array: this.#array().name })),
      ),
      element("h3", {}, "Pictures of this array"),
      element(
        "div",
        { class: "take-row" },
        this.#button("save-png", "Picture (PNG)", () =>
          this.#savePicture("png", (array) => takePicture(context.stream, array)),
        ),
        this.#button("save-gif", `Film of ${FILM_S} s (GIF)`, () =>
          this.#savePicture("gif", (array) => takeFilm(context.stream, array, FILM_S)),
        ),
      ),
      element("form", { method: "dialog" }, element("button", { class: "button" }, "Close")),
    );
    this.element.addEventListener("close", () => window.clearInterval(this.#timer));
    context.paused.follow((paused) => (this.#pausedAtS = paused ? context.stream.latestTimeS : undefined));
    context.stream.parameters.follow((parameters) => {
      this.#record.disabled = typeof parameters.get("/recording") !== "boolean";
      setText(this.#record, parameters.get("/recording") === true ? "End the recording" : "Record");
    });
  }

  show(): void {
    setText(this.#words, "");
    this.element.showModal();
    void this.#try(() => this.#list.refresh());
    this.#timer = window.setInterval(() => void this.#list.refresh().catch(() => undefined), REFRESH_MS);
  }

  #button(role: string, words: string, act: () => Promise<void>): HTMLButtonElement {
    return button(words, () => void this.#try(act), { "data-role": role });
  }

  async #try(act: () => Promise<void>): Promise<void> {
    try {
      await act();
    } catch (error) {
      setText(this.#words, errorText(error));
    }
  }

  #array(): ArrayDescription {
    const array = this.#context.suit.selected.value;
    if (array === undefined) throw new Error("There is no array.");
    return array;
  }

  async #switchRecording(): Promise<void> {
    const { stream } = this.#context;
    if (stream.parameters.value.get("/recording") === true) stream.setParameter("/recording", false);
    else if (this.#name.value === "") stream.setParameter("/recording", true);
    else await stream.callService("/recordings/begin", { name: this.#name.value });
    setText(this.#words, "");
    await this.#list.refresh();
  }

  /** Up to the moment that the page shows. */
  async #saveMinute(what: { array?: string }): Promise<void> {
    const { stream } = this.#context;
    const toS = this.#pausedAtS ?? stream.latestTimeS;
    const time =
      toS === undefined
        ? {}
        : {
            from_ms: Math.max(0, Math.floor(1000 * (toS - Number(this.#length.value)))),
            to_ms: Math.max(0, Math.ceil(1000 * toS)),
          };
    const { file, frames, forces } = (await stream.callService("/recordings/save", { ...what, ...time })) as {
      file: string;
      frames: number;
      forces?: string;
    };
    setText(this.#words, `${file}: ${frames} frames${forces === undefined ? "" : `; ${forces}: their newtons`}`);
    for (const name of forces === undefined ? [file] : [file, forces]) await saveRecorded(stream, name);
  }

  async #savePicture(ending: string, take: (array: ArrayDescription) => Promise<Picture>): Promise<void> {
    const array = this.#array();
    setText(this.#words, "One moment ...");
    const { blob, stampS } = await take(array);
    const file = `${nameWithTime(array.name, stampS)}.${ending}`;
    saveBlob(blob, file);
    setText(this.#words, `${file} is saved.`);
  }
}
