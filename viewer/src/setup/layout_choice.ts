// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden } from "../dom";
import { rgbOf } from "../render/color_map";
import type { Stream } from "../stream/stream";
import type { Theme } from "../theme";
import { type Part, piecesOf } from "./marked_bytes";
import type { Shape } from "./touch_feed";

/** A layout of bytes that dermis does not know, as /layout/propose has it. */
export interface Proposal {
  summary: string;
  layout: string;
  reasons: string[];
  doubts: string[];
  left_over: string[];
  open: string[];
  rows: number;
  cols: number;
  frames: number;
  /** Readings of a frame, row by row. */
  example: (number | null)[];
  parts: Part[];
}

const LEGEND: readonly (readonly [what: string, words: string])[] = [
  ["values", "readings"],
  ["time", "time"],
  ["number", "numbers of frames, rows, arrays"],
  ["mark", "marks"],
  ["checksum", "checksum"],
  ["other", "passed over"],
  ["", "text, or left over"],
];

/** Shows what the bytes of an unknown device may be, and lets one layout be used. */
export class LayoutChoice {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #theme: Theme;
  readonly #list = element("div", { class: "port-list", role: "group", "aria-label": "Layouts" });
  readonly #bytes = element("pre", {
    class: "first-bytes",
    tabindex: 0,
    "aria-label": "The bytes, marked by what they hold",
    "data-role": "marked-bytes",
  });
  readonly #words = element("ul", { class: "dim", "data-role": "layout-words" });
  readonly #map = element("canvas", {
    class: "layout-map",
    role: "img",
    "aria-label": "A frame as this layout reads it",
    "data-role": "layout-map",
  });
  #hex = "";
  #proposals: readonly Proposal[] = [];
  #chosen = 0;
  #known: Partial<Shape> = {};
  #round = 0;

  /** `choose`: a proposal is looked at. `use`: its layout is wanted, with what was known of the array. */
  constructor(
    stream: Stream,
    theme: Theme,
    private readonly choose: (proposal: Proposal) => void,
    use: (request: object) => void,
  ) {
    this.#stream = stream;
    this.#theme = theme;
    const legend = LEGEND.map(([what, words]) => element("span", { class: classOf(what) }, words));
    this.element = element(
      "div",
      { class: "setup-part", "data-role": "layout-choice", hidden: true },
      element("h3", {}, "These bytes may be"),
      this.#list,
      this.#words,
      this.#bytes,
      element("p", { class: "part-legend" }, ...legend),
      this.#map,
      button("Use this layout", () => use({ ...this.#known, place: this.#chosen }), { "data-role": "use-layout" }),
    );
  }

  forget(): void {
    this.#round += 1;
    setHidden(this.element, true);
  }

  /** Asks anew, with what is known of the array; layouts of a source that is read are none. */
  async propose(known: Partial<Shape>): Promise<void> {
    const round = ++this.#round;
    if (!this.#stream.services.value.has("/layout/propose")) return;
    const answer = (await this.#stream.callService("/layout/propose", known)) as {
      bytes: string;
      proposals: Proposal[];
    };
    if (round !== this.#round) return;
    this.#hex = answer.bytes;
    this.#proposals = answer.proposals;
    this.#known = known;
    const buttons = this.#proposals.map(({ summary }, place) =>
      button(summary, () => this.#show(place), { "data-proposal": place }),
    );
    this.#list.replaceChildren(...buttons);
    setHidden(this.element, this.#proposals.length === 0);
    if (this.#proposals.length > 0) this.#show(0);
  }

  #show(place: number): void {
    const proposal = this.#proposals[place];
    if (proposal === undefined) return;
    this.#chosen = place;
    for (const [index, item] of [...this.#list.children].entries())
      item.setAttribute("aria-pressed", String(index === place));
    const sentences = [`${proposal.frames} frames`, ...proposal.reasons, ...proposal.doubts, ...proposal.left_over];
    this.#words.replaceChildren(...sentences.map((words) => element("li", {}, words)));
    const pieces = piecesOf(this.#hex, proposal.parts);
    this.#bytes.replaceChildren(...pieces.map(({ words, what }) => element("span", { class: classOf(what) }, words)));
    this.#draw(proposal);
    this.choose(proposal);
  }

  #draw({ rows, cols, example }: Proposal): void {
    [this.#map.width, this.#map.height] = [cols, rows];
    this.#map.style.aspectRatio = `${cols} / ${rows}`;
    const known = example.filter((reading) => reading !== null);
    const lowest = known.reduce((one, other) => Math.min(one, other), Infinity);
    const range = known.reduce((one, other) => Math.max(one, other), -Infinity) - lowest || 1;
    const picture = new ImageData(cols, rows);
    for (const [taxel, reading] of example.entries()) {
      if (reading === null) continue;
      const color = rgbOf((reading - lowest) / range, this.#theme.shown.value === "light");
      picture.data.set([...color.map((channel) => 255 * channel), 255], 4 * taxel);
    }
    this.#map.getContext("2d")?.putImageData(picture, 0, 0);
  }
}

function classOf(what: string): string {
  return `part-${what === "" ? "none" : what}`;
}
