// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import { fixed } from "../format";
import { rgbOf } from "../render/color_map";
import type { Theme } from "../theme";
import { sentPlace, type WayRound } from "./corners";
import { Rest } from "./rest";
import type { Shape, Touch } from "./touch_feed";

/** The counts as they come, before anybody has described their array. */
export class LivePicture {
  readonly element: HTMLElement;
  readonly #theme: Theme;
  readonly #canvas = element("canvas", { role: "img", "aria-label": "The counts that come now" });
  readonly #dot = element("span", { class: "touch-dot", hidden: true });
  readonly #room = element("div", { class: "touch-picture" }, this.#canvas, this.#dot);
  readonly #words = element("p", { class: "dim", "data-role": "live-words" });
  #rest = new Rest();

  constructor(theme: Theme) {
    this.#theme = theme;
    this.element = element(
      "div",
      { class: "live-picture", "data-role": "live-picture", hidden: true },
      this.#room,
      this.#words,
    );
  }

  forget(): void {
    this.#rest = new Rest();
    setHidden(this.element, true);
  }

  /** `sent`: the shape of what comes; it is drawn as the array is, the lines turned. */
  show({ counts, touched }: Touch, sent: Shape, way: WayRound): void {
    const known = counts.filter((count) => count !== null);
    setHidden(this.element, known.length === 0);
    if (known.length === 0) return;
    const lowest = known.reduce((one, other) => Math.min(one, other));
    const highest = known.reduce((one, other) => Math.max(one, other));
    setText(this.#words, `Now: ${fixed(lowest, 0)} to ${fixed(highest, 0)} counts`);
    this.#draw(this.#rest.sharesOf(counts), sent, way);
    setHidden(this.#dot, touched === null);
    if (touched === null) return;
    this.#dot.style.top = `${(100 * (touched[0] + 0.5)) / sent.rows}%`;
    this.#dot.style.left = `${(100 * (touched[1] + 0.5)) / sent.cols}%`;
  }

  #draw(shares: readonly (number | null)[], sent: Shape, way: WayRound): void {
    const { rows, cols } = way.transpose ? { rows: sent.cols, cols: sent.rows } : sent;
    this.#room.style.aspectRatio = `${cols} / ${rows}`;
    [this.#canvas.width, this.#canvas.height] = [cols, rows];
    const picture = new ImageData(cols, rows);
    for (let row = 0; row < rows; ++row) {
      for (let col = 0; col < cols; ++col) {
        const place = sentPlace([row, col], { rows, cols }, way);
        const share = shares[place[0] * sent.cols + place[1]];
        if (share === null || share === undefined) continue;
        const color = rgbOf(share, this.#theme.shown.value === "light");
        picture.data.set([...color.map((channel) => 255 * channel), 255], 4 * (row * cols + col));
      }
    }
    this.#canvas.getContext("2d")?.putImageData(picture, 0, 0);
  }
}
