// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setData, setText } from "../dom";
import type { ViewContext } from "../view";
import { connectionWords } from "./connection_words";

const PERIOD_MS = 200;

/** How the connection is, in words. */
export class ConnectionPill {
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #words = element("span");
  #drawnMs = 0;

  constructor(context: ViewContext) {
    this.#context = context;
    const { stream } = context;
    this.element = element(
      "button",
      { class: "pill connection", "data-role": "connection", title: "Connect now", onclick: () => stream.connect() },
      element("span", { class: "lamp" }),
      this.#words,
    );
    stream.connection.follow(() => this.#show(performance.now()));
  }

  draw(nowMs: number): void {
    if (nowMs - this.#drawnMs >= PERIOD_MS) this.#show(nowMs);
  }

  #show(nowMs: number): void {
    this.#drawnMs = nowMs;
    const { stream, live, suit, paused } = this.#context;
    const connection = stream.connection.value;
    setData(document.documentElement, "connection", connection.kind);
    const { setup } = suit.description.value;
    const problem = live.statistics.value?.arrays.find(({ name }) => name === suit.selected.value?.name)?.error ?? "";
    const [level, words] = connectionWords({
      connection,
      nowMs,
      isAsked: setup !== undefined,
      isUnreadable: setup === undefined ? problem !== "" : setup.from !== "" && !setup.readable && setup.rows === null,
      isPaused: paused.value,
      playback: stream.playback.value?.status,
      silenceS: live.delay.silenceS(nowMs),
      lateS: live.delay.lateS,
    });
    setData(this.element, "level", level);
    setText(this.#words, words);
    this.element.title = problem === "" ? "Connect now" : problem;
  }
}
