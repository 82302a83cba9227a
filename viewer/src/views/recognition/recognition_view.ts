// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element } from "../../dom";
import { type Classification, readClassification } from "../../messages/classification";
import type { View, ViewContext, ViewFactory } from "../../view";
import { ClassBars } from "./class_bars";
import { LimitTable, ThreatLog } from "./limit_table";
import { TeachPanel } from "./teach_panel";
import "./recognition.css";

const AGE_PERIOD_MS = 200;

class RecognitionView implements View {
  readonly name = "recognition";
  readonly title = "Recognition";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #bars = new ClassBars();
  readonly #teach: TeachPanel;
  readonly #limits = new LimitTable();
  readonly #log = new ThreatLog();
  readonly #unfollow: (() => void)[] = [];
  #endArray: () => void = () => undefined;
  #news: Classification | undefined;
  #shownS = NaN;
  #ageMs = 0;

  constructor(context: ViewContext) {
    this.#context = context;
    this.#teach = new TeachPanel(context.stream, (classes) =>
      this.#bars.begin(context.suit.selected.value?.name ?? "", classes),
    );
    this.element = element(
      "div",
      { class: "view recognition-view", "data-view": "recognition" },
      element("div", { class: "column" }, this.#bars.element, this.#teach.element),
      element("div", { class: "column" }, this.#limits.element, this.#log.element),
    );
  }

  show(): void {
    const { suit, live } = this.#context;
    this.#unfollow.push(
      suit.selected.follow(() => this.#follow()),
      live.threats.limits.follow((limits) => this.#limits.show(limits)),
      live.threats.log.follow((log) => this.#log.show(log)),
    );
  }

  hide(): void {
    this.#endArray();
    for (const end of this.#unfollow.splice(0)) end();
  }

  draw(nowMs: number): void {
    this.#teach.draw(nowMs);
    const { paused, live } = this.#context;
    if (this.#news !== undefined && !paused.value) {
      this.#bars.show(this.#news);
      this.#shownS = this.#news.stampS;
      this.#news = undefined;
    }
    if (Number.isNaN(this.#shownS) || nowMs - this.#ageMs < AGE_PERIOD_MS) return;
    this.#ageMs = nowMs;
    this.#bars.showAge(live.latestS - this.#shownS);
  }

  #follow(): void {
    this.#endArray();
    const array = this.#context.suit.selected.value;
    if (array === undefined) return;
    this.#news = undefined;
    this.#shownS = NaN;
    this.#bars.begin(array.name, array.classes ?? []);
    this.#teach.begin(array);
    this.#endArray = this.#context.stream.subscribe(
      `/${array.name}/recognition`,
      (message) => (this.#news = readClassification(message)),
    );
  }
}

export const createRecognitionView: ViewFactory = (context) => new RecognitionView(context);
